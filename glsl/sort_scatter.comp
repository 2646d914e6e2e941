#version 460
#extension GL_GOOGLE_include_directive : require
// In the third step of a pass each run carries its keys, in order, to their places.
struct Params {
    uint pass; // of the sort, from 0
};
#define PARAMS Params
#include "sort.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(readonly, 3, uint, order)
BUFFER(, 4, uint, histogram)
BUFFER(writeonly, 5, uint, sorted_keys)
BUFFER(writeonly, 6, uint, sorted_order)
BUFFER(readonly, 7, uint, depth_keys)

void main() {
    uint run = gl_GlobalInvocationID.x;
    uint number = KEY_DIGIT;
    uint base = KEY_BASE;
    bool is_first = number == 0u; // the splats are in their own order
    uvec2 bounds = run_bounds(run, EYE.order.sort_runs, KEY_COUNT);
    for (uint i = bounds.x; i < bounds.y; i++) {
        uint key = is_first ? depth_keys.at[i] : keys.at[i];
        uint slot = run * DIGITS + digit(key - base, number);
        uint place = histogram.at[slot];
        histogram.at[slot] = place + 1u;
        sorted_keys.at[place] = key;
        sorted_order.at[place] = is_first ? i : order.at[i];
    }
}
