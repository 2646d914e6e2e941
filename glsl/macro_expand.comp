#version 460
#extension GL_GOOGLE_include_directive : require
// The third step of binning for GPUs writes the pairs of macro-tile and splat, front to back. A workgroup owns a partition of
// the pairs and finds whose they are, so that nobody waits for a splat over the whole picture. This is also the first count of
// the pairs' sort.
#include "macro_tiles.glsl"
#define KEY_COUNT counts.at[0].macro_pairs
#include "radix.glsl"
#include "workgroup_sum.glsl"
#include "workgroup_max.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uvec4, tile_masks)
BUFFER(readonly, 4, uint, rects)
BUFFER(readonly, 5, uint, chunk_begins)
BUFFER(writeonly, 6, uint, macro_keys)
BUFFER(writeonly, 7, uint, macro_splats)
BUFFER(writeonly, 8, uint, histogram)

// Splats that the workgroup looks at in a round, and those of an invocation: some chunks.
const uint OWN_SPLATS = 8u;
const uint ROUND_SPLATS = OWN_SPLATS * RADIX_GROUP_SIZE;

shared uint first_chunk; // that of the partition's first pair
shared uint skipped; // pairs of the first splat of a round that stand before the partition
// What an invocation owns of these is followed by a gap, so that neighbours use different memory banks.
shared uint words[ROUND_SPLATS + RADIX_GROUP_SIZE]; // the rectangles of the round's splats
// At the first pair of each splat the pair's number in the partition, and the splat's in the round counted from 1; elsewhere
// 0, or at last the same as before.
shared uint heads[RADIX_PARTITION + RADIX_GROUP_SIZE];
shared uint totals[DIGITS];

const int HEAD_BITS = 16;

uint word_place(uint splat) {
    return splat + splat / OWN_SPLATS;
}

uint head_place(uint pair) {
    return pair + pair / RADIX_KEYS;
}

// The last chunk whose pairs do not begin behind a pair.
uint chunk_of(uint pair, uint chunks) {
    uint first = 0u;
    uint end = chunks;
    while (first + 1u < end) {
        uint middle = (first + end) / 2u;
        if (chunk_begins.at[middle] <= pair) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

Rect rect_at(uint word, uint i) {
    if (word == RECT_LARGE) {
        return rect_of_bounds(tile_masks.at[order.at[i]].zw);
    }
    return rect_of_word(word);
}

void load_round(uint first_splat, uint splats) {
    for (uint k = 0u; k < OWN_SPLATS; k++) {
        uint splat = k * RADIX_GROUP_SIZE + gl_LocalInvocationIndex;
        words[word_place(splat)] = first_splat + splat < splats ? rects.at[first_splat + splat] : RECT_NONE;
    }
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        heads[head_place(k * RADIX_GROUP_SIZE + gl_LocalInvocationIndex)] = 0u;
    }
    barrier();
}

// Marks the first pairs of a round's splats, whose pairs begin at `begin`; returns where they end.
uint mark_heads(uvec2 bounds, uint first_splat, uint begin) {
    uint own[OWN_SPLATS];
    uint sum = 0u;
    for (uint k = 0u; k < OWN_SPLATS; k++) {
        uint splat = gl_LocalInvocationIndex * OWN_SPLATS + k;
        uint word = words[word_place(splat)];
        own[k] = word == RECT_NONE ? 0u : pairs_of(rect_at(word, first_splat + splat));
        sum += own[k];
    }
    uint total;
    uint pair = begin + exclusive_sum(sum, total);
    for (uint k = 0u; k < OWN_SPLATS; k++) {
        uint end = pair + own[k];
        if (own[k] > 0u && pair < bounds.y && end > bounds.x) {
            uint head = max(pair, bounds.x) - bounds.x;
            heads[head_place(head)] = head << HEAD_BITS | (gl_LocalInvocationIndex * OWN_SPLATS + k + 1u);
            if (head == 0u) {
                skipped = bounds.x - pair;
            }
        }
        pair = end;
    }
    barrier();
    return begin + total;
}

// Hands each mark on to the pairs behind it.
void fill_heads() {
    uint first = gl_LocalInvocationIndex * RADIX_KEYS;
    uint own = 0u;
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        own = max(own, heads[head_place(first + k)]);
    }
    uint last = exclusive_max(own);
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        last = max(last, heads[head_place(first + k)]);
        heads[head_place(first + k)] = last;
    }
    barrier();
}

// The splat of a pair, by its number in the round.
uint splat_of(uint pair) {
    return bitfieldExtract(heads[head_place(pair)], 0, HEAD_BITS) - 1u;
}

void write_pair(uvec2 bounds, uint pair, uint first_splat, uint ordered) {
    uint head = heads[head_place(pair)] >> HEAD_BITS;
    uint splat = splat_of(pair);
    uint word = words[word_place(splat)];
    Rect tiles = rect_at(word, first_splat + splat);
    Rect rect = macro_rect(tiles);
    uint number = pair - head + (head == 0u ? skipped : 0u);
    uvec2 at = rect.first + uvec2(number % rect.size.x, number / rect.size.x);
    uint key = pair_key(at, tiles, needs_mask(word));
    macro_keys.at[bounds.x + pair] = key;
    macro_splats.at[bounds.x + pair] = ordered;
    atomicAdd(totals[digit(pair_macro_tile(key), 0u)], 1u); // the sums do not depend on the order
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uvec2 bounds = partition_bounds(gl_WorkGroupID.x, KEY_COUNT);
    uint splats = counts.at[0].visible + counts.at[0].cutoff;
    uint chunks = (splats + CHUNK_SPLATS - 1u) / CHUNK_SPLATS;
    totals[local] = 0u;
    if (local == 0u) {
        first_chunk = chunk_of(bounds.x, chunks);
    }
    barrier();
    uint first_splat = first_chunk * CHUNK_SPLATS;
    uint begin = chunk_begins.at[first_chunk];
    while (begin < bounds.y && first_splat < splats) {
        load_round(first_splat, splats);
        uint end = mark_heads(bounds, first_splat, begin);
        fill_heads();
        for (uint first = local; first < RADIX_PARTITION; first += KEYS_AT_ONCE * RADIX_GROUP_SIZE) {
            uint ordered[KEYS_AT_ONCE];
            for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
                // Pairs of other rounds have no splat in this one.
                ordered[k] = order.at[min(first_splat + splat_of(first + k * RADIX_GROUP_SIZE), splats - 1u)];
            }
            for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
                uint pair = first + k * RADIX_GROUP_SIZE;
                if (bounds.x + pair >= begin && bounds.x + pair < min(end, bounds.y)) {
                    write_pair(bounds, pair, first_splat, ordered[k]);
                }
            }
        }
        barrier();
        first_splat += ROUND_SPLATS;
        begin = end;
    }
    histogram.at[COUNT_PLACE(local, gl_WorkGroupID.x)] = totals[local];
}
