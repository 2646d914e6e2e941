// The passes of a sort that are skipped. Included by the scan of each pipeline set, after the size of its workgroup and the
// buffers `counts` and `histogram` are declared; RANGES says how many runs or partitions have noted their least and their
// greatest key, and RANGE_PLACE where.
#ifndef RARA_SORT_PASSES
#define RARA_SORT_PASSES
#include "sort.glsl"

shared uint least;
shared uint greatest;

// One workgroup decides by the least and the greatest key which of the passes are skipped.
void decide_passes(uint passes) {
    uint local = gl_LocalInvocationIndex;
    if (local == 0u) {
        least = ~0u;
        greatest = 0u;
    }
    barrier();
    uint my_least = ~0u;
    uint my_greatest = 0u;
    for (uint i = local; i < RANGES; i += gl_WorkGroupSize.x) {
        my_least = min(my_least, histogram.at[RANGE_PLACE(i)]);
        my_greatest = max(my_greatest, histogram.at[RANGE_PLACE(i) + 1u]);
    }
    // The least and the greatest do not depend on the order of the atomics.
    atomicMin(least, my_least);
    atomicMax(greatest, my_greatest);
    barrier();
    if (local != 0u) {
        return;
    }
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
