#version 460
#extension GL_GOOGLE_include_directive : require
// After the sort, splats of one depth are in the order of the blocks; this puts them into that of their numbers. Equal
// depths are rare and few, so each invocation looks for them in a run of its own and orders them alone; where too many have
// one depth, its workgroup merges them together.
#include "sort.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(coherent, 3, uint, order)
BUFFER(coherent, 4, uint, scratch)
BUFFER(readonly, 5, Splat, splats)

// Most that one invocation orders alone.
const uint FEW = 24u;

shared uvec2 ties[SORT_GROUP_SIZE]; // begin and end of equal keys that are too many for one
shared uint tie_count;

// A survivor's number in the scene.
uint number(uint survivor) {
    return floatBitsToUint(splats.at[survivor].middle.z);
}

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

uint at(bool second, uint i) {
    return second ? scratch.at[i] : order.at[i];
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
void order_together(uint begin, uint end) {
    bool second = false;
    for (uint width = 1u; width < end - begin; width *= 2u) {
        for (uint i = begin + gl_LocalInvocationIndex; i < end; i += SORT_GROUP_SIZE) {
            uint piece = (i - begin) / width;
            uint own = begin + piece * width;
            uint other = min(begin + (piece ^ 1u) * width, end);
            uint survivor = at(second, i);
            uint rank = rank_among(second, other, min(other + width, end), number(survivor));
            uint place = min(own, other) + (i - own) + rank;
            if (second) {
                order.at[place] = survivor;
            } else {
                scratch.at[place] = survivor;
            }
        }
        second = !second;
        memoryBarrierBuffer();
        barrier();
    }
    if (second) {
        for (uint i = begin + gl_LocalInvocationIndex; i < end; i += SORT_GROUP_SIZE) {
            order.at[i] = scratch.at[i];
        }
        memoryBarrierBuffer();
        barrier();
    }
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint count = KEY_COUNT;
    uvec2 bounds = run_bounds(gl_GlobalInvocationID.x, FRAME.order.sort_runs, count);
    uint i = bounds.x;
    // Ties that begin in the run before belong to that one.
    while (i < bounds.y && i > 0u && keys.at[i] == keys.at[i - 1u]) {
        i++;
    }
    bool again;
    do {
        uvec2 tie = uvec2(0u);
        while (i < bounds.y && tie.y == 0u) {
            uint key = keys.at[i];
            uint end = i + 1u;
            while (end < count && keys.at[end] == key) {
                end++;
            }
            if (end - i > FEW) {
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
                    order_together(ties[owner].x, ties[owner].y);
                }
            }
        }
        // All read it before the next round sets the count.
        again = tie_count > 0u;
        barrier();
    } while (again);
}
