// The passes of a sort that are skipped. Included by the scan of each kernel set, after the buffer `counts` is declared.
#ifndef RARA_SORT_PASSES
#define RARA_SORT_PASSES
#include "sort.glsl"

// Decides by the least and the greatest key which of the passes are skipped.
void decide_passes(uint least, uint greatest, uint passes) {
    uint base = least & ~(DIGITS - 1u);
    // Even keys that are all alike take a pass, which carries them to their buffer.
    uint digits = uint(max(findMSB(greatest - base), 0)) / SORT_BITS + 1u;
    uint skipped = passes - min(digits, passes);
    counts.at[0].sort_base = base;
    counts.at[0].sort_skipped = skipped;
    for (uint pass = 0u; pass < passes; pass++) {
        counts.at[0].sort_pass_groups[pass] = pass < skipped ? uvec4(0u, 1u, 1u, 0u) : counts.at[0].sort_groups;
    }
}

#endif
