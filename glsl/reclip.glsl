// A reclipped frame keeps RECLIP_WORDS words of each block: which of its Gaussians in view change, are visible or are cut,
// their totals, their places in the lists, and its side. In a reclipped frame the camera stands still; the splats
// are all Gaussians in view, clipped away or not.
#ifndef RARA_RECLIP
#define RARA_RECLIP
#include "masks.glsl"

const uint RECLIP_CHANGED = 0u;
const uint RECLIP_VISIBLE = WORDS;
const uint RECLIP_CUT = 2u * WORDS;
// How many are visible, cut, invisible and changed; the last is valid where the block is revisited.
const uint RECLIP_TOTALS = 3u * WORDS;
// The places of the first changed and of the first cut one.
const uint RECLIP_PLACES = RECLIP_TOTALS + 4u;
const uint RECLIP_SIDE = RECLIP_PLACES + 2u;

// True when the clip has to revisit a block's Gaussians: it cuts the block, or settles it in another way than before.
bool is_revisited(uint revisit) {
    return (revisit & 3u) == SIDE_CUTOFF;
}

// The side that the block had in the frame before.
uint block_side_before(uint revisit) {
    return revisit >> 2;
}

#endif
