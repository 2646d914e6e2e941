#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a Gaussian: ordered stream compaction. The place of a survivor is its workgroup's offset plus the set
// bits before its own, so the lists are in the order of the file in every run.
#include "frame.glsl"

layout(local_size_x = GROUP_SIZE) in;

BUFFER(readonly, 1, uint, masks)
BUFFER(readonly, 2, uvec2, group_offsets)
BUFFER(writeonly, 3, uvec2, survivors)
BUFFER(writeonly, 4, uint, cutoffs)

const uint WORDS = GROUP_SIZE / 32u;

// Set bits of a workgroup's mask before bit `local`.
uint rank(uint base, uint local) {
    uint word = local >> 5;
    uint count = bitCount(masks.at[base + word] & ((1u << (local & 31u)) - 1u));
    for (uint before = 0u; before < word; before++) {
        count += bitCount(masks.at[base + before]);
    }
    return count;
}

void main() {
    uint group = LINEAR_GROUP;
    uint local = gl_LocalInvocationIndex;
    uint index = group * GROUP_SIZE + local;
    if (index >= FRAME.gaussian_count) {
        return;
    }
    uint base = group * 2u * WORDS;
    uint bit = 1u << (local & 31u);
    if ((masks.at[base + (local >> 5)] & bit) == 0u) {
        return;
    }
    uvec2 offset = group_offsets.at[group];
    uint cut = NOT_CUT;
    if ((masks.at[base + WORDS + (local >> 5)] & bit) != 0u) {
        cut = offset.y + rank(base + WORDS, local);
        cutoffs.at[cut] = index;
    }
    survivors.at[offset.x + rank(base, local)] = uvec2(index, cut);
}
