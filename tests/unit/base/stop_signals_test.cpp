// SPDX-License-Identifier: Apache-2.0
#include "core/base/stop_signals.h"

#include <condition_variable>
#include <csignal>
#include <gtest/gtest.h>
#include <mutex>
#include <thread>
#include <unistd.h>

namespace fieldcast {
namespace {

using namespace std::chrono_literals;

TEST(StopSignals, AreWaitedFor) {
    const StopSignals signals;
    EXPECT_FALSE(signals.wait(1ms));
    ::kill(::getpid(), SIGTERM);
    EXPECT_TRUE(signals.wait(10s));
    EXPECT_FALSE(signals.wait(1ms));
    ::kill(::getpid(), SIGINT);
    EXPECT_TRUE(signals.wait(10s));
}

TEST(StopSignals, ReachWhoWaitsThroughThreadsThatExistedBefore) {
    const std::jthread earlier([](const std::stop_token& stop) { // as libraries start some before main()
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        never.wait(lock, stop, [] { return false; });
    });
    const StopSignals signals;
    for (const int signal : {SIGTERM, SIGTERM, SIGINT}) {
        ::kill(::getpid(), signal); // nobody waits: the kernel gives it to the thread that does not block it
        EXPECT_TRUE(signals.wait(10s));
    }
}

TEST(StopSignals, MayBeWaitedForByAnotherThread) {
    const StopSignals signals;
    std::jthread([&] {
        EXPECT_FALSE(signals.wait(1ms));
        ::kill(::getpid(), SIGINT);
        EXPECT_TRUE(signals.wait(10s));
    }).join();
}

} // namespace
} // namespace fieldcast
