// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <atomic>
#include <gtest/gtest.h>
#include <stdexcept>

namespace fieldcast {
namespace {

TEST(WorkerPool, DoesEveryItemOnce) {
    for (const unsigned threads : {1U, 2U, 5U}) {
        WorkerPool pool(threads);
        for (const std::size_t count : {0U, 1U, 3U, 1000U}) {
            std::vector<std::atomic<int>> done(count);
            pool.for_each(count, [&](std::size_t i) { ++done[i]; });
            for (const auto& times : done) {
                EXPECT_EQ(times, 1);
            }
        }
    }
}

TEST(WorkerPool, RethrowsAndStaysUsable) {
    WorkerPool pool(3);
    std::atomic<int> done = 0;
    const auto fail = [&](std::size_t i) {
        if (i == 5) {
            throw std::runtime_error("item 5");
        }
        ++done;
    };
    EXPECT_THROW(pool.for_each(100'000, fail), std::runtime_error);
    EXPECT_LT(done, 100'000);
    done = 0;
    pool.for_each(10, [&](std::size_t) { ++done; });
    EXPECT_EQ(done, 10);
}

TEST(WorkerPool, CallersTakeTurns) {
    WorkerPool pool(2);
    std::atomic<int> done = 0;
    {
        std::vector<std::jthread> callers;
        for (int i = 0; i < 4; ++i) {
            callers.emplace_back([&] { pool.for_each(100, [&](std::size_t) { ++done; }); });
        }
    }
    EXPECT_EQ(done, 400);
}

TEST(WorkerPool, ZeroMeansHardwareThreads) {
    EXPECT_GE(WorkerPool(0).thread_count(), 1U);
}

} // namespace
} // namespace fieldcast
