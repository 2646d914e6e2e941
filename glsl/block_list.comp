#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup lists the blocks whose Gaussians differ, in order, and writes the indirect command over them.
struct Params {
    uint stage; // which stage they are for: 0 clip, 1 classify
};
#define PARAMS Params
#include "frame.glsl"
#include "region/sides.glsl"
#include "groups.glsl"

layout(local_size_x = BLOCK_SIZE) in;

// In the two low bits.
BUFFER(readonly, 1, uint, sides)
BUFFER(writeonly, 2, uint, block_list)
BUFFER(writeonly, 3, FrameCounts, counts)

shared uint run_totals[BLOCK_SIZE];

void main() {
    uint local = gl_LocalInvocationIndex;
    uint run = (FRAME.scene.block_count + BLOCK_SIZE - 1u) / BLOCK_SIZE;
    uint begin = min(local * run, FRAME.scene.block_count);
    uint end = min(begin + run, FRAME.scene.block_count);
    uint total = 0u;
    for (uint block = begin; block < end; block++) {
        total += (sides.at[block] & 3u) == SIDE_CUTOFF ? 1u : 0u;
    }
    run_totals[local] = total;
    barrier();
    uint place = 0u;
    for (uint other = 0u; other < local; other++) {
        place += run_totals[other];
    }
    for (uint block = begin; block < end; block++) {
        if ((sides.at[block] & 3u) == SIDE_CUTOFF) {
            block_list.at[place++] = block;
        }
    }
    if (local == BLOCK_SIZE - 1u) {
        if (push.params.stage == 0u) {
            counts.at[0].clip_groups = groups(place, 1u);
        } else {
            counts.at[0].classify_groups = groups(place, 1u);
        }
    }
}
