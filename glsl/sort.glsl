// The parts that all pipelines of the sort share: a stable radix sort from the least significant digit on.
//
// The first count finds the least and the greatest key. Counted from the least, the keys may differ in fewer digits than
// the scene's bounds allow. The first passes are then skipped, so that the sorted keys end up in the same buffer. Whichever
// pass is the first carries the keys from `depth_keys`, where project has left them, and the later ones from `keys`.
#ifndef RARA_SORT
#define RARA_SORT
#include "frame.glsl"
#include "runs.glsl"

const uint DIGITS = 1u << SORT_BITS;

#ifndef KEY_COUNT
#define KEY_COUNT (counts.at[0].visible + counts.at[0].cutoff)
// Keys are counted from this multiple of DIGITS, so that the first count need not know it.
#define KEY_BASE (counts.at[0].sort_base)
// The digit that the pass sorts by.
#define KEY_DIGIT (push.params.pass - counts.at[0].sort_skipped)
#endif

uint digit(uint key, uint number) {
    return bitfieldExtract(key, int(number * SORT_BITS), int(SORT_BITS));
}

#endif
