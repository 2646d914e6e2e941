// On which side of a region something lies.
#ifndef RARA_REGION_SIDES
#define RARA_REGION_SIDES

const uint SIDE_CULLED = 0u;
const uint SIDE_INVISIBLE = 1u;
const uint SIDE_VISIBLE = 2u;
const uint SIDE_CUTOFF = 3u;

#endif
