#version 460
#extension GL_GOOGLE_include_directive : require
// The third step of binning for GPUs writes the pairs of macro-tile and splat, front to back. A workgroup owns a partition of
// the pairs and finds whose they are, so that nobody waits for a splat over the whole picture. This is also the first count of
// the pairs' sort.
#include "macro_tiles.glsl"
#define KEY_COUNT counts.at[0].macro_pairs
#include "radix.glsl"
#include "workgroup_max.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uint, pair_begins)
BUFFER(readonly, 4, uint, rect_firsts)
BUFFER(readonly, 5, uint, rect_sizes)
BUFFER(writeonly, 6, uint, macro_keys)
BUFFER(writeonly, 7, uint, macro_splats)
BUFFER(writeonly, 8, uint, histogram)

shared uint ends[2]; // the splats of the partition's first and last pair
// At the first pair of each splat the splat, counted from 1 and the partition's first; elsewhere 0, or at last the same as
// before. An invocation's pairs are followed by a gap, so that neighbours use different memory banks.
shared uint owners[RADIX_PARTITION + RADIX_GROUP_SIZE];
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

// The place of one of the partition's pairs.
uint owner_place(uint pair) {
    return pair + pair / RADIX_KEYS;
}

void mark_first_pairs(uvec2 bounds) {
    for (uint splat = ends[0] + gl_LocalInvocationIndex; splat <= ends[1]; splat += RADIX_GROUP_SIZE) {
        uint begin = max(pair_begins.at[splat], bounds.x);
        uint columns = bitfieldExtract(rect_sizes.at[splat], 0, 16);
        // One without pairs begins where the next one does.
        if (begin < bounds.y && columns != 0u) {
            owners[owner_place(begin - bounds.x)] = splat - ends[0] + 1u;
        }
    }
}

// Hands each mark on to the pairs behind it.
void fill_owners() {
    uint first = gl_LocalInvocationIndex * RADIX_KEYS;
    uint own = 0u;
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        own = max(own, owners[owner_place(first + k)]);
    }
    uint last = exclusive_max(own);
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        last = max(last, owners[owner_place(first + k)]);
        owners[owner_place(first + k)] = last;
    }
}

void write_pair(uint pair, uint splat) {
    uint first = rect_firsts.at[splat];
    uint size = rect_sizes.at[splat];
    Rect tiles = Rect(uvec2(first & 0xffffu, first >> 16), uvec2(size & 0xffffu, bitfieldExtract(size, 16, 15)));
    Rect rect = macro_rect(tiles);
    uint number = pair - pair_begins.at[splat];
    uvec2 at = rect.first + uvec2(number % rect.size.x, number / rect.size.x);
    uint key = pair_key(at, tiles, (size & PAIR_MASKED) != 0u);
    macro_keys.at[pair] = key;
    macro_splats.at[pair] = order.at[splat];
    atomicAdd(totals[digit(pair_macro_tile(key), 0u)], 1u); // the sums do not depend on the order
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    uvec2 bounds = partition_bounds(p, KEY_COUNT);
    totals[local] = 0u;
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        owners[owner_place(k * RADIX_GROUP_SIZE + local)] = 0u;
    }
    if (local < 2u) {
        ends[local] = owner(local == 0u ? bounds.x : bounds.y - 1u);
    }
    barrier();
    mark_first_pairs(bounds);
    barrier();
    fill_owners();
    barrier();
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint pair = k * RADIX_GROUP_SIZE + local;
        if (bounds.x + pair < bounds.y) {
            write_pair(bounds.x + pair, ends[0] + owners[owner_place(pair)] - 1u);
        }
    }
    barrier();
    histogram.at[COUNT_PLACE(local, p)] = totals[local];
}
