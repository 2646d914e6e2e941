// The sort by runs of consecutive keys, each owned by one invocation, which walks its run in order, so that equal keys keep
// their order without any ranking inside a workgroup. The histogram holds the runs' counts of each digit, one run after the
// other, and behind them all the least and the greatest key of each.
#ifndef RARA_SORT_RUNS
#define RARA_SORT_RUNS
#include "sort.glsl"

#define RANGES EYE.order.sort_runs
#define RANGE_PLACE(run) (EYE.order.sort_runs * DIGITS + 2u * (run))

#endif
