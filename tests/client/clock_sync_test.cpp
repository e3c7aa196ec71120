// SPDX-License-Identifier: Apache-2.0
#include "client/net/clock_sync.h"

#include <gtest/gtest.h>

namespace fieldcast::test {
namespace {

using namespace client::net;

TEST(ClockSync, TrustsTheShortestRoundTrip) {
    ClockSync clock;
    EXPECT_FALSE(clock.client_from_server_ns(5));
    clock.add({0, 1000, 1000, 900}); // slow: offset −550
    clock.add({1000, 1510, 1510, 1020});
    EXPECT_EQ(clock.round_trip_ns(), 20);
    EXPECT_EQ(clock.client_from_server_ns(1510), 1010);
    EXPECT_FALSE(clock.client_from_server_ns(0)); // 0 means unknown
}

TEST(ClockSync, IgnoresExchangesThatCannotBeTrue) {
    ClockSync clock;
    clock.add({100, 10, 5, 200});            // sent before received
    clock.add({200, 10, 10, 100});           // received before sent
    clock.add({0, INT64_MAX, INT64_MAX, 1}); // would overflow
    EXPECT_FALSE(clock.round_trip_ns());
}

} // namespace
} // namespace fieldcast::test
