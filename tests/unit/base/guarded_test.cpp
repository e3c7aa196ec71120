// SPDX-License-Identifier: Apache-2.0
#include "core/base/guarded.h"

#include <gtest/gtest.h>
#include <memory>
#include <thread>
#include <vector>

namespace fieldcast {
namespace {

TEST(Guarded, SerialisesAccess) {
    Guarded<int> counter;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 8; ++i) {
            threads.emplace_back([&] {
                for (int round = 0; round < 1000; ++round) {
                    ++*counter.lock();
                }
            });
        }
    }
    EXPECT_EQ(*counter.lock(), 8000);
}

TEST(Guarded, WaitReturnsOnceThePredicateHolds) {
    Guarded<int> value;
    std::condition_variable changed;
    std::jthread writer([&] {
        for (int i = 1; i <= 3; ++i) {
            *value.lock() = i;
            changed.notify_all();
        }
    });
    auto lock = value.lock();
    lock.wait(changed, [](int seen) { return seen == 3; });
    EXPECT_EQ(*lock, 3);
}

TEST(Guarded, WaitUntilGivesUpAtTheDeadline) {
    Guarded<int> value(7);
    std::condition_variable changed;
    auto lock = value.lock();
    const auto past = std::chrono::steady_clock::now();
    EXPECT_FALSE(lock.wait_until(changed, past, [](int seen) { return seen == 8; }));
    EXPECT_TRUE(lock.wait_until(changed, past, [](int seen) { return seen == 7; }));
}

TEST(Guarded, HoldsValuesThatOnlyMove) {
    Guarded<std::unique_ptr<int>> value(std::make_unique<int>(5));
    EXPECT_EQ(**value.lock(), 5);
    const std::unique_ptr<int> taken = std::exchange(*value.lock(), nullptr);
    EXPECT_EQ(*value.lock(), nullptr);
}

} // namespace
} // namespace fieldcast
