// SPDX-License-Identifier: Apache-2.0
#include "core/base/stop_signals.h"

#include <csignal>
#include <gtest/gtest.h>
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
        while (!stop.stop_requested()) {
            std::this_thread::sleep_for(1ms);
        }
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
