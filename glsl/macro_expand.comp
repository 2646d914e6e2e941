#version 460
#extension GL_GOOGLE_include_directive : require
// The third step of binning for GPUs writes the pairs of macro-tile and splat, front to back. Each invocation finds the
// splats of its pairs, so that nobody waits for a splat over the whole picture. This is also the first count of the pairs' sort.
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
shared uint begins[RADIX_PARTITION]; // where the pairs of the splats in between begin, a window of them at a time
shared uint totals[DIGITS];

// The splat that a pair is one of: the last one whose pairs do not begin behind it.
uint owner(uint pair) {
    uint first = 0u;
    uint end = counts.at[0].visible + counts.at[0].cutoff;
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

// The same among the first `count` of a window.
uint owner_in_window(uint pair, uint count) {
    uint first = 0u;
    uint end = count;
    while (first + 1u < end) {
        uint middle = (first + end) / 2u;
        if (begins[middle] <= pair) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

void write_pair(uint pair, uint number, uint splat) {
    uint first = rect_firsts.at[splat];
    uint columns = rect_columns.at[splat];
    uvec2 at = uvec2(first & 0xffffu, first >> 16) + uvec2(number % columns, number / columns);
    uint key = at.y * macro_columns() + at.x;
    macro_keys.at[pair] = key;
    macro_splats.at[pair] = order.at[splat];
    atomicAdd(totals[digit(key, 0u)], 1u); // the sums do not depend on the order
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    uvec2 bounds = partition_bounds(p, KEY_COUNT);
    totals[local] = 0u;
    if (local < 2u) {
        ends[local] = owner(local == 0u ? bounds.x : bounds.y - 1u);
    }
    barrier();
    uint last = ends[1];
    // There is one window, unless splats without pairs stand between the others.
    for (uint window = ends[0]; window <= last; window += RADIX_PARTITION) {
        uint count = min(last + 1u - window, RADIX_PARTITION);
        barrier();
        for (uint k = 0u; k < RADIX_KEYS; k++) {
            uint i = k * RADIX_GROUP_SIZE + local;
            if (i < count) {
                begins[i] = pair_begins.at[window + i];
            }
        }
        uint next = window + count <= last ? pair_begins.at[window + count] : bounds.y;
        barrier();
        for (uint pair = bounds.x + local; pair < bounds.y; pair += RADIX_GROUP_SIZE) {
            if (pair >= begins[0] && pair < next) {
                uint i = owner_in_window(pair, count);
                write_pair(pair, pair - begins[i], window + i);
            }
        }
    }
    barrier();
    histogram.at[COUNT_PLACE(local, p)] = totals[local];
}
