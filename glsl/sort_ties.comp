#version 460
#extension GL_GOOGLE_include_directive : require
// After the sort, splats of one depth are in the order of the blocks; this puts them into that of their numbers. Equal
// depths are rare and few, so each invocation looks for them in a run of its own and orders them alone. Where too many for
// one invocation have one depth, its workgroup merges them together, and where they are a layer, it sorts them by the
// digits of their numbers.
#include "sort.glsl"
#include "splat_gaussians.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(coherent, 3, uint, order)
BUFFER(coherent, 4, uint, scratch)
// The sort's, of which each invocation uses its own run's part.
BUFFER(coherent, 5, uint, histogram)
BUFFER(readonly, 6, uint, depth_keys)
#define STEPS 1u
#include "ties.glsl"

uint number(uint splat_index) {
    return depth_keys.at[number_place(splat_index)];
}

// Most that a workgroup merges. Beyond, the steps of the merges outweigh the histograms of the digits.
const uint MANY = 4096u;

shared uvec2 ties[SORT_GROUP_SIZE]; // begin and end of equal keys that are too many for one
shared uint tie_count;
shared uint totals[DIGITS]; // of each digit, all runs together

void order_alone(uint begin, uint end) {
    for (uint i = begin + 1u; i < end; i++) {
        uint moved = order.at[i];
        uint place = i;
        uint its_number = number(moved);
        for (; place > begin && number(order.at[place - 1u]) > its_number; place--) {
            order.at[place] = order.at[place - 1u];
        }
        order.at[place] = moved;
    }
}

// How many of the ordered [begin, end) have a number below the given one.
uint rank_among(bool second, uint begin, uint end, uint its_number) {
    uint low = begin;
    uint high = end;
    while (low < high) {
        uint middle = (low + high) >> 1;
        if (number(at(second, middle)) < its_number) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low - begin;
}

// The whole workgroup merges ever longer pieces, to and fro between the two buffers.
void merge_together(uint begin, uint end) {
    bool second = false;
    for (uint width = 1u; width < end - begin; width *= 2u) {
        for (uint i = begin + gl_LocalInvocationIndex; i < end; i += SORT_GROUP_SIZE) {
            uint piece = (i - begin) / width;
            uint own = begin + piece * width;
            uint other = min(begin + (piece ^ 1u) * width, end);
            uint splat_index = at(second, i);
            uint rank = rank_among(second, other, min(other + width, end), number(splat_index));
            put(!second, min(own, other) + (i - own) + rank, splat_index);
        }
        second = !second;
        publish();
    }
    if (second) {
        copy_back(begin, end);
    }
}

// Does so as a pass of the sort: each invocation counts a run of its own, and carries it in order.
void sort_by_digit(bool second, uint begin, uint end, uint digit_number) {
    uint local = gl_LocalInvocationIndex;
    uint first_slot = gl_WorkGroupID.x * SORT_GROUP_SIZE * DIGITS;
    uint slots = first_slot + local * DIGITS;
    uvec2 run = begin + run_bounds(local, SORT_GROUP_SIZE, end - begin);
    for (uint d = 0u; d < DIGITS; d++) {
        histogram.at[slots + d] = 0u;
    }
    for (uint i = run.x; i < run.y; i++) {
        histogram.at[slots + digit(number(at(second, i)), digit_number)]++;
    }
    publish();
    for (uint d = local; d < DIGITS; d += SORT_GROUP_SIZE) {
        uint total = 0u;
        for (uint other = 0u; other < SORT_GROUP_SIZE; other++) {
            total += histogram.at[first_slot + other * DIGITS + d];
        }
        totals[d] = total;
    }
    barrier();
    for (uint d = local; d < DIGITS; d += SORT_GROUP_SIZE) {
        uint place = begin;
        for (uint before = 0u; before < d; before++) {
            place += totals[before];
        }
        for (uint other = 0u; other < SORT_GROUP_SIZE; other++) {
            uint slot = first_slot + other * DIGITS + d;
            uint count = histogram.at[slot];
            histogram.at[slot] = place;
            place += count;
        }
    }
    publish();
    for (uint i = run.x; i < run.y; i++) {
        uint splat_index = at(second, i);
        uint slot = slots + digit(number(splat_index), digit_number);
        uint place = histogram.at[slot];
        histogram.at[slot] = place + 1u;
        put(!second, place, splat_index);
    }
    publish();
}

// The first place from a given one on whose key equals the next one, or the given end. The search has a loop of its own: a
// vector of invocations leaves it together, and then orders a tie of each at once.
uint next_tie(uint i, uint end, uint count) {
    end = min(end, count - 1u); // the last key has no next one
    uint key = keys.at[i];
    while (i < end) {
        uint next = keys.at[i + 1u];
        if (next == key) {
            break;
        }
        key = next;
        i++;
    }
    return i;
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint count = KEY_COUNT;
    uvec2 bounds = run_bounds(gl_GlobalInvocationID.x, EYE.order.sort_runs, count);
    uint i = bounds.x;
    // Ties that begin in the run before belong to that one.
    while (i < bounds.y && i > 0u && keys.at[i] == keys.at[i - 1u]) {
        i++;
    }
    bool again;
    do {
        uvec2 tie = uvec2(0u);
        while (i < bounds.y && tie.y == 0u) {
            i = next_tie(i, bounds.y, count);
            if (i == bounds.y) {
                break;
            }
            uint key = keys.at[i];
            uint end = i + 1u;
            while (end < count && keys.at[end] == key) {
                end++;
            }
            if (end - i > TIES_ALONE) {
                tie = uvec2(i, end);
            } else if (end - i > 1u) {
                order_alone(i, end);
            }
            i = end;
        }
        if (local == 0u) {
            tie_count = 0u;
        }
        ties[local] = tie;
        barrier();
        if (tie.y != 0u) {
            atomicAdd(tie_count, 1u);
        }
        barrier();
        if (tie_count > 0u) {
            for (uint owner = 0u; owner < SORT_GROUP_SIZE; owner++) {
                if (ties[owner].y != 0u) {
                    uvec2 together = ties[owner];
                    if (together.y - together.x > MANY) {
                        sort_together(together.x, together.y);
                    } else {
                        merge_together(together.x, together.y);
                    }
                }
            }
        }
        // All read it before the next round sets the count.
        again = tie_count > 0u;
        barrier();
    } while (again);
}
