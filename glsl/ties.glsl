// Splats of one depth, by their numbers. Included after the buffers `order`, `scratch` and `splats` are declared.
#ifndef RARA_TIES
#define RARA_TIES

// Most that one invocation orders alone.
const uint TIES_ALONE = 24u;

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

#endif
