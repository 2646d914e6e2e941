// What a reclipped frame knows of each block, RECLIP_WORDS words: which of its Gaussians in view change, are visible or are
// cut, their totals, their places in the lists, and its side. In a reclipped frame the camera stands still; the survivors
// are all Gaussians in view, clipped away or not.
#ifndef RARA_RECLIP
#define RARA_RECLIP
#include "masks.glsl"

const uint RECLIP_CHANGED = 0u;
const uint RECLIP_VISIBLE = WORDS;
const uint RECLIP_CUT = 2u * WORDS;
// Visible, cut and invisible ones; changed ones, valid where the block is looked at.
const uint RECLIP_TOTALS = 3u * WORDS;
// The first changed and the first cut one's places.
const uint RECLIP_PLACES = RECLIP_TOTALS + 4u;
const uint RECLIP_SIDE = RECLIP_PLACES + 2u;

// Whether the clip has to revisit a block's Gaussians: it cuts the block, or settles it in another way than before.
bool is_revisited(uint revisit) {
    return (revisit & 3u) == SIDE_CUTOFF;
}

// The side that the block had in the frame before.
uint block_side_before(uint revisit) {
    return revisit >> 2;
}

#endif
