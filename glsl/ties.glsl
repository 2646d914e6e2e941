// Puts splats of one depth into the order of their numbers. Included after the size of the workgroup and the buffers `order` and
// `scratch` are declared.
#ifndef RARA_TIES
#define RARA_TIES
#include "frame.glsl"

// A splat's number in the scene. The includer says where it is.
uint number(uint splat_index);

uint at(bool second, uint i) {
    return second ? scratch.at[i] : order.at[i];
}

void put(bool second, uint i, uint splat_index) {
    if (second) {
        scratch.at[i] = splat_index;
    } else {
        order.at[i] = splat_index;
    }
}

// All invocations of the workgroup see what the others have written.
void publish() {
    memoryBarrierBuffer();
    barrier();
}

// The whole workgroup carries splats to the other buffer by one digit of their numbers. The includer says how.
void sort_by_digit(bool second, uint begin, uint end, uint digit_number);

// Splats that each invocation waits for together, STEPS apart by the workgroup's size; the includer says how many.
void copy_back(uint begin, uint end) {
    for (uint first = begin; first < end; first += STEPS * gl_WorkGroupSize.x) {
        uint own[STEPS];
        for (uint k = 0u; k < STEPS; k++) {
            uint i = first + k * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
            own[k] = i < end ? scratch.at[i] : 0u;
        }
        for (uint k = 0u; k < STEPS; k++) {
            uint i = first + k * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
            if (i < end) {
                order.at[i] = own[k];
            }
        }
    }
    publish();
}

shared uint differing; // bits in which the numbers differ

// The whole workgroup sorts by the digits in which the numbers differ.
void sort_together(uint begin, uint end) {
    if (gl_LocalInvocationIndex == 0u) {
        differing = 0u;
    }
    barrier();
    uint first_number = number(order.at[begin]);
    uint differs = 0u;
    for (uint first = begin; first < end; first += STEPS * gl_WorkGroupSize.x) {
        for (uint k = 0u; k < STEPS; k++) {
            // Those beyond the end repeat the last one.
            uint i = first + k * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
            differs |= number(order.at[min(i, end - 1u)]) ^ first_number;
        }
    }
    atomicOr(differing, differs);
    publish();
    uint differing_bits = differing; // the next layer may reset it as soon as this one is sorted
    bool second = false;
    for (uint digit_number = 0u; digit_number * SORT_BITS < 32u; digit_number++) {
        if (digit(differing_bits, digit_number) != 0u) {
            sort_by_digit(second, begin, end, digit_number);
            second = !second;
        }
    }
    if (second) {
        copy_back(begin, end);
    }
}

#endif
