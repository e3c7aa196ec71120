// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fieldcast::client::load {

/// Counts durations in buckets whose width grows with the value, so that every percentile is known to within 0.1 % at
/// a fixed cost: linear in each power of two, 1024 buckets wide.
/// Follows: Gil Tene. HdrHistogram: A High Dynamic Range Histogram. http://hdrhistogram.org.
/// Differs: one unit (microseconds) and one precision (three digits); memory grows with the largest value.
class LatencyHistogram {
public:
    /// Adds a value in whole microseconds. Negative values (from clocks that disagree) count as 0, values above 19
    /// hours as 19 hours.
    void add(std::int64_t value_us, std::uint64_t times = 1);
    void add(const LatencyHistogram& other);

    std::uint64_t count() const { return count_; }
    double mean_us() const; ///< 0 without values
    double deviation_us() const;
    std::int64_t largest_us() const { return largest_us_; } ///< exact; 0 without values

    /// The value that `share` (0 … 1) of all values do not exceed: the upper end of its bucket, at most the largest
    /// value. 0 without values.
    std::int64_t percentile_us(double share) const;

    /// A point of the percentile curve.
    struct Point {
        std::int64_t value_us = 0;
        double share = 0.0;
        std::uint64_t count = 0; ///< number of values up to this one
    };
    /// The curve with `ticks` points per halving of the distance to 1; the last point is at 1.
    std::vector<Point> curve(int ticks = 5) const;

    /// The curve in milliseconds as text, as plotters of .hgrm files read it.
    std::string to_hgrm() const;

    static constexpr std::int64_t kLargestUs = (std::int64_t{1} << 36) - 1;

private:
    std::vector<std::uint64_t> buckets_;
    std::uint64_t count_ = 0;
    double sum_us_ = 0.0;
    double sum_of_squares_ = 0.0;
    std::int64_t largest_us_ = 0;
};

} // namespace fieldcast::client::load
