// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace fieldcast::metrics {

/// A value that only grows. Thread-safe; never blocks.
class Counter {
public:
    void add(std::uint64_t count = 1) { value_.fetch_add(count, std::memory_order_relaxed); }
    std::uint64_t value() const { return value_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::uint64_t> value_ = 0;
};

/// Counts values per interval between bounds. Thread-safe; never blocks. A reader may see a value in a count that the
/// sum does not contain yet.
class Histogram {
public:
    /// `bounds` ascend; a last interval without an upper bound is added.
    explicit Histogram(std::span<const double> bounds);

    void observe(double value);

    const std::vector<double>& bounds() const { return bounds_; }
    /// Cumulative counts: values up to bounds()[i], then all values. One more than there are bounds.
    std::vector<std::uint64_t> cumulative_counts() const;
    double sum() const { return sum_.load(std::memory_order_relaxed); }

private:
    std::vector<double> bounds_;
    std::vector<std::atomic<std::uint64_t>> counts_; ///< one more than bounds
    std::atomic<double> sum_ = 0.0;
};

/// Bounds for durations in seconds: 0.1 ms to 10 s, about three per decade.
std::span<const double> second_bounds();

} // namespace fieldcast::metrics
