// SPDX-License-Identifier: Apache-2.0
// The numbers, and the page that shows them.
#include "server/metrics/process_metrics.h"
#include "server/metrics/registry.h"

#include <gmock/gmock.h>
#include <thread>

namespace fieldcast::metrics {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::array kBounds{0.1, 1.0};

TEST(Histogram, CountsEachValueUnderEveryBoundThatItDoesNotExceed) {
    Histogram histogram(kBounds);
    for (const double value : {0.05, 0.1, 0.5, 2.0, 3.0}) {
        histogram.observe(value);
    }
    EXPECT_EQ(histogram.cumulative_counts(), (std::vector<std::uint64_t>{2, 3, 5}));
    EXPECT_DOUBLE_EQ(histogram.sum(), 5.65);
}

TEST(Page, IsPrometheusText) {
    Page page;
    Histogram histogram(kBounds);
    histogram.observe(0.5);
    page.add_gauge({"b_bytes", "Bytes."}, {{"name", "a \"b\" \\ c\nd"}}, 1.5);
    page.add_histogram({"c_seconds", "Times."}, {{"stage", "x"}}, histogram);
    page.add_counter({"a_total", "Events."}, {}, 12345678901234.0);
    page.add_gauge({"b_bytes", "Bytes."}, {{"name", "e"}}, 0.0);
    EXPECT_EQ(page.text(), "# HELP a_total Events.\n# TYPE a_total counter\na_total 12345678901234\n"
                           "# HELP b_bytes Bytes.\n# TYPE b_bytes gauge\n"
                           "b_bytes{name=\"a \\\"b\\\" \\\\ c\\nd\"} 1.5\nb_bytes{name=\"e\"} 0\n"
                           "# HELP c_seconds Times.\n# TYPE c_seconds histogram\n"
                           "c_seconds_bucket{stage=\"x\",le=\"0.1\"} 0\nc_seconds_bucket{stage=\"x\",le=\"1\"} 1\n"
                           "c_seconds_bucket{stage=\"x\",le=\"+Inf\"} 1\n"
                           "c_seconds_sum{stage=\"x\"} 0.5\nc_seconds_count{stage=\"x\"} 1\n");
}

TEST(Registry, GivesTheSameInstrumentForTheSameLabels) {
    Registry registry;
    Counter& one = registry.counter({"a_total", "A."}, {{"x", "1"}});
    Counter& two = registry.counter({"a_total", "A."}, {{"x", "2"}});
    registry.counter({"a_total", "A."}, {{"x", "1"}}).add(3);
    EXPECT_EQ(one.value(), 3U);
    EXPECT_EQ(two.value(), 0U);
    EXPECT_THAT(registry.page().text(), HasSubstr("a_total{x=\"1\"} 3\na_total{x=\"2\"} 0\n"));
}

TEST(Registry, AsksCollectorsWhileTheyLive) {
    Registry registry;
    {
        const Collector collector = registry.on_collect([](Page& page) { page.add_gauge({"g", "G."}, {}, 7.0); });
        EXPECT_THAT(registry.page().text(), HasSubstr("g 7\n"));
    }
    EXPECT_THAT(registry.page().text(), Not(HasSubstr("g 7")));
}

TEST(Registry, CountsFromManyThreads) {
    Registry registry;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 10'000; ++k) {
                registry.counter({"a_total", "A."}, {}).add();
                registry.histogram({"h_seconds", "H."}, {}, kBounds).observe(0.5);
            }
        });
    }
    registry.page();
    threads.clear();
    EXPECT_EQ(registry.counter({"a_total", "A."}, {}).value(), 40'000U);
    EXPECT_DOUBLE_EQ(registry.histogram({"h_seconds", "H."}, {}, kBounds).sum(), 20'000.0);
}

TEST(ProcessMetrics, AreThoseOfThisProcess) {
    Page page;
    add_process_metrics(page);
    const std::string text = page.text();
    for (const char* const name : {"process_cpu_seconds_total ", "process_resident_memory_bytes ", "process_threads ",
                                   "process_open_fds ", "process_max_fds ", "process_virtual_memory_bytes "}) {
        EXPECT_THAT(text, HasSubstr(std::string("\n").append(name)));
    }
    const auto value_of = [&](const std::string& name) {
        return std::stod(text.substr(text.find(std::string("\n").append(name).append(" ")) + name.size() + 2));
    };
    EXPECT_GT(value_of("process_resident_memory_bytes"), 1e6); // no C++ program with gtest is smaller
    EXPECT_LT(value_of("process_resident_memory_bytes"), value_of("process_virtual_memory_bytes"));
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    EXPECT_NEAR(value_of("process_start_time_seconds"), static_cast<double>(now), 600.0); // started minutes ago at most
}

} // namespace
} // namespace fieldcast::metrics
