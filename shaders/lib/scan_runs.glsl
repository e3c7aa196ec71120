// SPDX-License-Identifier: Apache-2.0
// Prefix sums over a list that one group of kRuns invocations goes through, each a run of it.
#ifndef FIELDCAST_LIB_SCAN_RUNS
#define FIELDCAST_LIB_SCAN_RUNS

const uint kRuns = 256;

shared uint sums_[kRuns];

struct Run {
    uint begin;
    uint end;
};

Run run_of(uint invocation, uint count) {
    uint length = (count + kRuns - 1u) / kRuns;
    uint begin = min(invocation * length, count);
    return Run(begin, min(begin + length, count));
}

// The sum of all runs before this invocation's; all invocations call it.
uint scan_runs(uint invocation, uint sum) {
    sums_[invocation] = sum;
    barrier();
    for (uint distance = 1u; distance < kRuns; distance *= 2u) {
        uint before = invocation >= distance ? sums_[invocation - distance] : 0u;
        barrier();
        sums_[invocation] += before;
        barrier();
    }
    return sums_[invocation] - sum;
}

// After scan_runs.
uint sum_of_runs() {
    return sums_[kRuns - 1u];
}

#endif
