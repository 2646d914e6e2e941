// Runs of consecutive elements, one for each invocation, which walks its run in order, so that a sort stays stable.
#ifndef RARA_RUNS
#define RARA_RUNS

// First and last element (exclusive) of a run, of so many runs over so many elements.
uvec2 run_bounds(uint run, uint runs, uint count) {
    uint size = (count + runs - 1u) / runs;
    uint begin = min(run * size, count);
    return uvec2(begin, min(begin + size, count));
}

#endif
