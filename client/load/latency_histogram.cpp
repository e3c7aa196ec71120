// SPDX-License-Identifier: Apache-2.0
#include "client/load/latency_histogram.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>

namespace fieldcast::client::load {
namespace {

// Values below 2048 have a bucket each. Above, each power of two has 1024, as the upper half of 2048 does.
constexpr int kBits = 11;
constexpr std::uint64_t kHalf = 1U << (kBits - 1);

int shift_of(std::uint64_t value) {
    return std::max(0, static_cast<int>(std::bit_width(value)) - kBits);
}

std::size_t bucket_of(std::uint64_t value) {
    const int shift = shift_of(value);
    return static_cast<std::size_t>(shift) * kHalf + static_cast<std::size_t>(value >> shift);
}

/// The largest value of a bucket.
std::int64_t end_of(std::size_t bucket) {
    if (bucket < 2 * kHalf) {
        return static_cast<std::int64_t>(bucket);
    }
    const std::size_t shift = bucket / kHalf - 1;
    const std::uint64_t first = static_cast<std::uint64_t>(bucket - shift * kHalf) << shift;
    return static_cast<std::int64_t>(first + (std::uint64_t{1} << shift) - 1);
}

/// Rank (1 … count) of the value that `share` of `count` values do not exceed.
std::uint64_t rank_of(double share, std::uint64_t count) {
    const double wanted = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count));
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted));
}

template <class... Values> std::string line(const char* format, Values... values) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

} // namespace

void LatencyHistogram::add(std::int64_t value_us, std::uint64_t times) {
    if (times == 0) {
        return;
    }
    const std::int64_t value = std::clamp<std::int64_t>(value_us, 0, kLargestUs);
    const std::size_t bucket = bucket_of(static_cast<std::uint64_t>(value));
    if (bucket >= buckets_.size()) {
        buckets_.resize(bucket + 1);
    }
    buckets_[bucket] += times;
    count_ += times;
    const auto number = static_cast<double>(value);
    sum_us_ += number * static_cast<double>(times);
    sum_of_squares_ += number * number * static_cast<double>(times);
    largest_us_ = std::max(largest_us_, value);
}

void LatencyHistogram::add(const LatencyHistogram& other) {
    buckets_.resize(std::max(buckets_.size(), other.buckets_.size()));
    for (std::size_t i = 0; i < other.buckets_.size(); ++i) {
        buckets_[i] += other.buckets_[i];
    }
    count_ += other.count_;
    sum_us_ += other.sum_us_;
    sum_of_squares_ += other.sum_of_squares_;
    largest_us_ = std::max(largest_us_, other.largest_us_);
}

double LatencyHistogram::mean_us() const {
    return count_ == 0 ? 0.0 : sum_us_ / static_cast<double>(count_);
}

double LatencyHistogram::deviation_us() const {
    const double mean = mean_us();
    return count_ == 0 ? 0.0 : std::sqrt(std::max(0.0, sum_of_squares_ / static_cast<double>(count_) - mean * mean));
}

std::int64_t LatencyHistogram::percentile_us(double share) const {
    const std::uint64_t rank = rank_of(share, count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
        seen += buckets_[i];
        if (seen >= rank) {
            return std::min(end_of(i), largest_us_);
        }
    }
    return largest_us_;
}

std::vector<LatencyHistogram::Point> LatencyHistogram::curve(int ticks) const {
    std::vector<Point> points;
    double share = 0.0;
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
        seen += buckets_[i];
        while (buckets_[i] != 0 && share < 1.0 && seen >= rank_of(share, count_)) {
            points.push_back({std::min(end_of(i), largest_us_), share, seen});
            const double halvings = std::floor(std::log2(1.0 / (1.0 - share))) + 1.0;
            share += 1.0 / (std::exp2(halvings) * ticks);
            if (seen == count_) { // all further points are at the largest value
                share = 1.0;
            }
        }
    }
    if (count_ > 0) {
        points.push_back({largest_us_, 1.0, count_});
    }
    return points;
}

std::string LatencyHistogram::to_hgrm() const {
    constexpr double kMs = 1e-3;
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::string text = line("%12s %14s %10s %14s\n\n", "Value", "Percentile", "TotalCount", "1/(1-Percentile)");
    for (const Point& point : curve()) {
        text += line("%12.3f %2.12f %10llu", static_cast<double>(point.value_us) * kMs, point.share,
                     number(point.count));
        text += point.share < 1.0 ? line(" %14.2f\n", 1.0 / (1.0 - point.share)) : std::string("\n");
    }
    const std::size_t octaves = buckets_.empty() ? 1 : static_cast<std::size_t>(shift_of(
                                                           static_cast<std::uint64_t>(largest_us_))) + 1;
    text += line("#[Mean    = %12.3f, StdDeviation   = %12.3f]\n", mean_us() * kMs, deviation_us() * kMs);
    text += line("#[Max     = %12.3f, Total count    = %12llu]\n", static_cast<double>(largest_us_) * kMs,
                 number(count_));
    text += line("#[Buckets = %12llu, SubBuckets     = %12llu]\n", number(octaves), number(2 * kHalf));
    return text;
}

} // namespace fieldcast::client::load
