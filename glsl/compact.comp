#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block with splats, one invocation a Gaussian, for an ordered stream compaction. A splat's place is
// its block's offset plus the set bits before its own, so the lists are in the order of the scene in every run.
#include "layer.glsl"
#include "masks.glsl"
#include "splat_gaussians.glsl"

layout(local_size_x = BLOCK_SIZE) in;
// True where splats may be cut.
layout(constant_id = 0) const bool CUTS = false;

BUFFER_OF(readonly, 1, block_list, uvec4 groups; uint at[])
BUFFER(readonly, 2, uint, block_sides)
BUFFER(readonly, 3, uint, masks)
BUFFER(readonly, 4, uvec2, block_offsets)
BUFFER(writeonly, 5, uint, splat_gaussians)
BUFFER(writeonly, 6, uint, cutoffs)

// Set bits of a block's mask before bit `local`.
uint rank(uint base, uint local) {
    uint count = 0u;
    for (uint word = 0u; word <= local >> 5; word++) {
        count += bits_before(masks.at[base + word], word, local);
    }
    return count;
}

void put(uint splat_index, uint index, uint cut) {
    splat_gaussians.at[splat_index] = index;
    if (CUTS) {
        splat_gaussians.at[cut_place(splat_index)] = cut;
    }
}

void main() {
    uint group = LINEAR_GROUP;
    uint local = gl_LocalInvocationIndex;
    if (group >= block_list.groups.w) {
        return;
    }
    uint block = block_list.at[group];
    enter_layer_of_block(block);
    if (local >= block_length(block)) {
        return;
    }
    uint index = block * BLOCK_SIZE + local;
    uvec2 offset = block_offsets.at[block];
    if (block_sides.at[block] == SIDE_VISIBLE) {
        put(offset.x + local, index, NOT_CUT);
        return;
    }
    uint base = block * 2u * WORDS;
    uint bit = 1u << (local & 31u);
    if ((masks.at[base + (local >> 5)] & bit) == 0u) {
        return;
    }
    uint cut = NOT_CUT;
    if (CUTS && (masks.at[base + WORDS + (local >> 5)] & bit) != 0u) {
        cut = offset.y + rank(base + WORDS, local);
        cutoffs.at[cut] = index;
    }
    put(offset.x + rank(base, local), index, cut);
}
