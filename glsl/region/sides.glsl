// On which side of a region something lies, and how the surfaces' answers make the region's.
#ifndef RARA_REGION_SIDES
#define RARA_REGION_SIDES
#include "frame.glsl"

const uint SIDE_CULLED = 0u;
const uint SIDE_INVISIBLE = 1u;
const uint SIDE_VISIBLE = 2u;
const uint SIDE_CUTOFF = 3u;

// The answer of one surface that is the region's, whatever the others say: what one drops no intersection holds, what one
// keeps every union does.
uint side_that_decides() {
    return FRAME.region.op == OP_AND ? SIDE_INVISIBLE : SIDE_VISIBLE;
}

// The region's answer where no surface decides and none cuts.
uint side_undecided() {
    return FRAME.region.op == OP_AND ? SIDE_VISIBLE : SIDE_INVISIBLE;
}

#endif
