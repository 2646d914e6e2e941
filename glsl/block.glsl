// Asks a region about a whole block of Gaussians, from its bounds.
#ifndef RARA_BLOCK
#define RARA_BLOCK
#include "region/box_side.glsl"

// The box around the centres, a little wider than exact.
vec3 block_middle(Block block) {
    return 0.5 * block.low_reach.xyz + 0.5 * block.high_sigma.xyz;
}

vec3 block_half(Block block) {
    return 0.5 * block.high_sigma.xyz - 0.5 * block.low_reach.xyz + 1e-6 * (abs(block.low_reach.xyz) + abs(block.high_sigma.xyz));
}

float block_support(Block block, float widening) {
    return box_support(widening * max(block.low_reach.w, 0.0), abs(block.high_sigma.w));
}

// The region's side of a block, with what perspective widens the band by at most.
uint block_clip_side(Block block, float widening) {
    return box_side(block_middle(block), block_half(block), block_support(block, widening));
}

#endif
