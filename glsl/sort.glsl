// Stable least-significant-digit radix sort. Each invocation owns a run of consecutive keys and walks it in order,
// so equal keys keep their order without any ranking inside a workgroup. Parameter 0 is the digit's first bit; parameter 1
// says what is sorted: 0 the survivors, 1 the pairs of tile and splat.
#ifndef RARA_SORT
#define RARA_SORT
#include "frame.glsl"

const uint DIGITS = 1u << SORT_BITS;

#define KEY_COUNT (push.param[1] == 0u ? counts.at[0].visible + counts.at[0].cutoff : counts.at[0].pairs)

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
