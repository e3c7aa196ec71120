// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace fieldcast::bench::fanout {

/// What a server used while some clients read.
struct Sample {
    std::size_t clients = 0;
    double cpu_s = 0.0;     ///< of the server
    double megabytes = 0.0; ///< that arrived at all clients together, 10^6
    double frames = 0.0;    ///< likewise
};

/// CPU milliseconds that another megabyte costs, when it goes to another client: the slope of the least squares line
/// through the samples, so that what a server does once for all its clients does not count. Samples differ in bytes.
double marginal_ms_per_megabyte(const std::vector<Sample>& samples);

/// Of several rounds.
struct Spread {
    double median = 0.0;
    double smallest = 0.0;
    double largest = 0.0;
};
Spread spread_of(std::vector<double> values); ///< which must not be empty

} // namespace fieldcast::bench::fanout
