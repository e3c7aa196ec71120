// SPDX-License-Identifier: Apache-2.0
#include "client/load/latency_histogram.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <random>
#include <sstream>

namespace fieldcast::client::load {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Nearest rank.
std::int64_t exact_percentile(const std::vector<std::int64_t>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

/// Latencies as networks make them: many short ones, a long tail, over seven powers of ten.
std::vector<std::int64_t> log_normal_values(std::size_t count) {
    std::mt19937 random(7);
    std::lognormal_distribution<double> latency(9.0, 2.5);
    std::vector<std::int64_t> values;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(static_cast<std::int64_t>(std::min(latency(random), 6e10)));
    }
    return values;
}

LatencyHistogram histogram_of(const std::vector<std::int64_t>& values) {
    LatencyHistogram histogram;
    for (const std::int64_t value : values) {
        histogram.add(value);
    }
    return histogram;
}

TEST(LatencyHistogram, AgreesWithExactPercentiles) {
    std::vector<std::int64_t> values = log_normal_values(100'000);
    const LatencyHistogram histogram = histogram_of(values);
    std::ranges::sort(values);
    for (const double share : {0.0, 0.001, 0.1, 0.5, 0.9, 0.95, 0.99, 0.999, 0.9999, 1.0}) {
        const auto exact = static_cast<double>(exact_percentile(values, share));
        const auto found = static_cast<double>(histogram.percentile_us(share));
        // A bucket is at most 1/1024 of its values wide, and its upper end stands for all of them.
        EXPECT_GE(found, exact) << share;
        EXPECT_LE(found, exact * (1.0 + 1.0 / 1024.0)) << share;
    }
    EXPECT_EQ(histogram.percentile_us(1.0), values.back());
    EXPECT_EQ(histogram.count(), values.size());
}

TEST(LatencyHistogram, IsExactForSmallValues) {
    std::vector<std::int64_t> values;
    for (std::int64_t value = 0; value < 2048; ++value) {
        values.push_back(value);
    }
    const LatencyHistogram histogram = histogram_of(values);
    for (const double share : {0.1, 0.25, 0.5, 0.77, 0.99}) {
        EXPECT_EQ(histogram.percentile_us(share), exact_percentile(values, share));
    }
}

TEST(LatencyHistogram, EveryValueFallsBetweenItsNeighbours) {
    for (std::int64_t value = 1; value < LatencyHistogram::kLargestUs / 2; value = value * 2 + value / 3 + 1) {
        for (const std::int64_t each : {value - 1, value, value + 1}) {
            LatencyHistogram histogram;
            histogram.add(each);
            histogram.add(LatencyHistogram::kLargestUs); // else the largest value bounds the bucket
            EXPECT_GE(histogram.percentile_us(0.5), each);
            EXPECT_LE(histogram.percentile_us(0.5), each + each / 1024);
        }
    }
}

TEST(LatencyHistogram, MeanAndDeviationAreExact) {
    LatencyHistogram histogram;
    histogram.add(1000, 3);
    histogram.add(5000);
    EXPECT_DOUBLE_EQ(histogram.mean_us(), 2000.0);
    EXPECT_NEAR(histogram.deviation_us(), std::sqrt(3.0e6), 1e-6);
    EXPECT_EQ(histogram.largest_us(), 5000);
    EXPECT_EQ(histogram.count(), 4U);
}

TEST(LatencyHistogram, KeepsValuesWithinItsRange) {
    LatencyHistogram histogram;
    histogram.add(-5);
    histogram.add(INT64_MAX);
    EXPECT_EQ(histogram.percentile_us(0.5), 0);
    EXPECT_EQ(histogram.largest_us(), LatencyHistogram::kLargestUs);
    EXPECT_EQ(LatencyHistogram().percentile_us(0.99), 0);
    EXPECT_TRUE(LatencyHistogram().curve().empty());
}

TEST(LatencyHistogram, SumsLikeOneHistogram) {
    const std::vector<std::int64_t> values = log_normal_values(2000);
    LatencyHistogram whole = histogram_of(values);
    LatencyHistogram first = histogram_of({values.begin(), values.begin() + 700});
    first.add(histogram_of({values.begin() + 700, values.end()}));
    for (double share = 0.0; share <= 1.0; share += 0.01) {
        EXPECT_EQ(first.percentile_us(share), whole.percentile_us(share));
    }
    EXPECT_EQ(first.count(), whole.count());
    EXPECT_EQ(first.largest_us(), whole.largest_us());
    EXPECT_NEAR(first.deviation_us(), whole.deviation_us(), 1e-6 * whole.deviation_us());
}

TEST(LatencyHistogram, TheCurveAgreesWithPercentilesAndEndsAtTheLargestValue) {
    const LatencyHistogram histogram = histogram_of(log_normal_values(10'000));
    const auto curve = histogram.curve();
    ASSERT_GT(curve.size(), 40U); // five points per halving of the distance to 1, down to 1 in 10,000
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        EXPECT_EQ(curve[i].value_us, histogram.percentile_us(curve[i].share)) << curve[i].share;
        EXPECT_LT(curve[i].share, curve[i + 1].share);
        EXPECT_LE(curve[i].count, curve[i + 1].count);
    }
    EXPECT_EQ(curve.back().value_us, histogram.largest_us());
    EXPECT_EQ(curve.back().share, 1.0);
    EXPECT_EQ(curve.back().count, 10'000U);
}

TEST(LatencyHistogram, WritesWhatPlottersRead) {
    const std::string text = histogram_of({1000, 2000, 2000, 4000}).to_hgrm();
    EXPECT_THAT(text, StartsWith("       Value     Percentile TotalCount 1/(1-Percentile)\n\n"));
    std::istringstream lines(text);
    std::string skipped;
    std::getline(lines, skipped);
    std::getline(lines, skipped);
    double value_ms = 0.0;
    double share = 0.0;
    std::uint64_t count = 0;
    double before = -1.0;
    while (before < 1.0 && lines >> value_ms >> share >> count) {
        EXPECT_GT(share, before);
        before = share;
        std::getline(lines, skipped);
    }
    EXPECT_EQ(before, 1.0);
    EXPECT_EQ(count, 4U);
    EXPECT_DOUBLE_EQ(value_ms, 4.0);
    EXPECT_THAT(text, HasSubstr("#[Mean    =        2.250, StdDeviation   =        1.090]"));
    EXPECT_THAT(text, HasSubstr("#[Max     =        4.000, Total count    =            4]"));
}

} // namespace
} // namespace fieldcast::client::load
