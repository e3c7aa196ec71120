// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace fieldcast::bench::fanout {

/// CPU time and data of a server while some clients read.
struct Sample {
    std::size_t clients = 0;
    double cpu_s = 0.0;     ///< CPU time of the server
    double megabytes = 0.0; ///< 10^6 bytes received by all clients together
    double frames = 0.0;    ///< frames received by all clients together
};

/// CPU milliseconds per additional megabyte to an additional client. This is the slope of the least squares line
/// through the samples, so work that a server does once for all clients does not count. The samples must differ in
/// bytes.
double marginal_ms_per_megabyte(const std::vector<Sample>& samples);

/// Median and extremes over several rounds.
struct Spread {
    double median = 0.0;
    double smallest = 0.0;
    double largest = 0.0;
};
Spread spread_of(std::vector<double> values); ///< `values` must not be empty

} // namespace fieldcast::bench::fanout
