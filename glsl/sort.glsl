// Stable least-significant-digit radix sort. Each invocation owns a run of consecutive keys and walks it in order,
// so equal keys keep their order without any ranking inside a workgroup.
//
// The first count finds the least and the greatest key. Counted from the least they differ in fewer digits, perhaps, than
// the scene's bounds allow; the passes too many are the first ones, so that the sorted keys end up in the same buffer.
// Project writes the keys to both: whichever pass is the first finds them.
#ifndef RARA_SORT
#define RARA_SORT
#include "frame.glsl"
#include "runs.glsl"

const uint DIGITS = 1u << SORT_BITS;

#define KEY_COUNT (counts.at[0].visible + counts.at[0].cutoff)
// What keys are counted from: a multiple of DIGITS, so that the first count need not know it.
#define KEY_BASE (counts.at[0].sort_base)
// The digit that the pass sorts by.
#define KEY_DIGIT (push.params.pass - counts.at[0].sort_skipped)

uint digit(uint key, uint number) {
    return bitfieldExtract(key, int(number * SORT_BITS), int(SORT_BITS));
}

// Where the histogram has a run's least and greatest key.
uint range_place(uint run) {
    return FRAME.order.sort_runs * DIGITS + 2u * run;
}

#endif
