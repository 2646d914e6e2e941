// Stable least-significant-digit radix sort. Each invocation owns a run of consecutive keys and walks it in order,
// so equal keys keep their order without any ranking inside a workgroup. Parameter 0 is the digit's first bit.
#ifndef RARA_SORT
#define RARA_SORT
#include "frame.glsl"

const uint DIGITS = 1u << SORT_BITS;

uint digit(uint key) {
    return bitfieldExtract(key, int(push.param[0]), int(SORT_BITS));
}

// First and last key (exclusive) of a run.
uvec2 run_bounds(uint run, uint count) {
    uint size = (count + FRAME.sort_runs - 1u) / FRAME.sort_runs;
    uint begin = min(run * size, count);
    return uvec2(begin, min(begin + size, count));
}

#endif
