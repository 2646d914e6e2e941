// Puts splats of one depth into the order of their numbers. Included after the size of the workgroup and the buffers `order`,
// `scratch`, `depth_keys` and `numbers` are declared.
#ifndef RARA_TIES
#define RARA_TIES
#include "depth_keys.glsl"

// A survivor's number in the scene.
uint number(uint survivor) {
    return depth_keys.at[number_place(survivor)];
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

void put(bool second, uint i, uint survivor) {
    if (second) {
        scratch.at[i] = survivor;
    } else {
        order.at[i] = survivor;
    }
}

// All invocations of the workgroup see what the others have written.
void publish() {
    memoryBarrierBuffer();
    barrier();
}

// The whole workgroup carries survivors to the other buffer by one digit of their numbers. The includer says how.
void sort_by_digit(bool second, uint begin, uint end, uint digit_number);

void copy_back(uint begin, uint end) {
    for (uint i = begin + gl_LocalInvocationIndex; i < end; i += gl_WorkGroupSize.x) {
        order.at[i] = scratch.at[i];
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
    for (uint i = begin + gl_LocalInvocationIndex; i < end; i += gl_WorkGroupSize.x) {
        uint survivor = order.at[i];
        uint its_number = number(survivor);
        numbers.at[survivor] = its_number;
        differs |= its_number ^ first_number;
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
