// Runs of consecutive elements, one an invocation: whoever owns a run walks it in order, which keeps what is stable so.
#ifndef RARA_RUNS
#define RARA_RUNS

// First and last element (exclusive) of a run, of so many runs over so many elements.
uvec2 run_bounds(uint run, uint runs, uint count) {
    uint size = (count + runs - 1u) / runs;
    uint begin = min(run * size, count);
    return uvec2(begin, min(begin + size, count));
}

#endif
