// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/cost.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::bench::fanout {

double marginal_ms_per_megabyte(const std::vector<Sample>& samples) {
    double mean_megabytes = 0.0;
    double mean_cpu_s = 0.0;
    for (const Sample& sample : samples) {
        mean_megabytes += sample.megabytes / static_cast<double>(samples.size());
        mean_cpu_s += sample.cpu_s / static_cast<double>(samples.size());
    }
    double covariance = 0.0;
    double variance = 0.0;
    for (const Sample& sample : samples) {
        const double megabytes = sample.megabytes - mean_megabytes;
        covariance += megabytes * (sample.cpu_s - mean_cpu_s);
        variance += megabytes * megabytes;
    }
    FC_ASSERT(variance > 0.0, "samples of equal bytes have no slope");
    return 1000.0 * covariance / variance;
}

Spread spread_of(std::vector<double> values) {
    FC_ASSERT(!values.empty(), "no values");
    std::ranges::sort(values);
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
    return {.median = median, .smallest = values.front(), .largest = values.back()};
}

} // namespace fieldcast::bench::fanout
