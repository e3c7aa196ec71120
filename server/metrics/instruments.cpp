// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/instruments.h"

#include <algorithm>
#include <array>

namespace fieldcast::metrics {

Histogram::Histogram(std::span<const double> bounds)
    : bounds_(bounds.begin(), bounds.end()), counts_(bounds.size() + 1) {}

void Histogram::observe(double value) {
    const auto bound = std::ranges::lower_bound(bounds_, value);
    const auto index = static_cast<std::size_t>(bound - bounds_.begin());
    counts_[index].fetch_add(1, std::memory_order_relaxed);
    sum_.fetch_add(value, std::memory_order_relaxed);
}

std::vector<std::uint64_t> Histogram::cumulative_counts() const {
    std::vector<std::uint64_t> counts;
    std::uint64_t count = 0;
    for (const auto& part : counts_) {
        count += part.load(std::memory_order_relaxed);
        counts.push_back(count);
    }
    return counts;
}

std::span<const double> second_bounds() {
    static constexpr std::array kBounds{0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025,
                                        0.05,   0.1,     0.25,   0.5,   1.0,    2.5,   5.0,  10.0};
    return kBounds;
}

} // namespace fieldcast::metrics
