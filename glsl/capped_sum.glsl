#ifndef RARA_CAPPED_SUM
#define RARA_CAPPED_SUM

// A sum that stays at the largest number instead of turning over.
uint capped_sum(uint a, uint b) {
    return a > ~0u - b ? ~0u : a + b;
}

#endif
