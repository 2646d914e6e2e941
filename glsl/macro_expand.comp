#version 460
#extension GL_GOOGLE_include_directive : require
// The third step of binning for GPUs writes the pairs of macro-tile and splat, front to back. Each invocation finds the
// splats of its pairs, so that nobody waits for a splat over the whole picture. It also is the first count of the pairs' sort.
#include "macro_tiles.glsl"
#define KEY_COUNT counts.at[0].macro_pairs
#include "radix.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uint, pair_begins)
BUFFER(readonly, 4, uint, rect_firsts)
BUFFER(readonly, 5, uint, rect_columns)
BUFFER(writeonly, 6, uint, macro_keys)
BUFFER(writeonly, 7, uint, macro_splats)
BUFFER(writeonly, 8, uint, histogram)

shared uint ends[2]; // the splats of the partition's first and last pair
shared uint totals[DIGITS];

// The splat that a pair is one of: the last one in [first, end) whose pairs do not begin behind it.
uint owner(uint pair, uint first, uint end) {
    while (first + 1u < end) {
        uint middle = (first + end) / 2u;
        if (pair_begins.at[middle] <= pair) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    uvec2 bounds = partition_bounds(p, KEY_COUNT);
    totals[local] = 0u;
    if (local < 2u) {
        ends[local] = owner(local == 0u ? bounds.x : bounds.y - 1u, 0u, counts.at[0].visible + counts.at[0].cutoff);
    }
    barrier();
    for (uint pair = bounds.x + local; pair < bounds.y; pair += RADIX_GROUP_SIZE) {
        uint i = owner(pair, ends[0], ends[1] + 1u);
        uint number = pair - pair_begins.at[i];
        uint first = rect_firsts.at[i];
        uint columns = rect_columns.at[i];
        uvec2 at = uvec2(first & 0xffffu, first >> 16) + uvec2(number % columns, number / columns);
        uint key = at.y * macro_columns() + at.x;
        macro_keys.at[pair] = key;
        macro_splats.at[pair] = order.at[i];
        atomicAdd(totals[digit(key, 0u)], 1u); // the sums do not depend on the order
    }
    barrier();
    histogram.at[COUNT_PLACE(local, p)] = totals[local];
}
