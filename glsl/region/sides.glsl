// On which side of a region something lies.
#ifndef RARA_REGION_SIDES
#define RARA_REGION_SIDES

const uint SIDE_CULLED = 0u;
const uint SIDE_INVISIBLE = 1u;
const uint SIDE_VISIBLE = 2u;
const uint SIDE_CUTOFF = 3u;
// The bits of a block's side. With SIDE_CUTOFF, and in the list of blocks for stage classify, another one may say that all of the
// block is in view.
const uint SIDE_BITS = 3u;
const uint WHOLLY_IN_VIEW = 0x80000000u;

#endif
