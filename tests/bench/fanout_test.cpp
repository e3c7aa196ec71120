// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/cost.h"
#include "bench/fanout/message_loop.h"
#include "core/base/error.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace fieldcast::bench::fanout {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(FanoutCost, IsTheSlopeWithoutWhatIsDoneOnceForAll) {
    constexpr double kOnce_s = 0.7;
    constexpr double kPerMegabyte_s = 0.002;
    std::vector<Sample> samples;
    for (const std::size_t clients : {1U, 4U, 16U}) {
        const double megabytes = 10.0 * static_cast<double>(clients);
        samples.push_back({.clients = clients,
                           .cpu_s = kOnce_s + kPerMegabyte_s * megabytes,
                           .megabytes = megabytes,
                           .frames = static_cast<double>(clients)});
    }
    EXPECT_NEAR(marginal_ms_per_megabyte(samples), 2.0, 1e-9); // rounding of a few double operations
}

TEST(FanoutCost, SpreadIsMedianAndExtremes) {
    const Spread odd = spread_of({3.0, 1.0, 2.0});
    EXPECT_EQ(odd.median, 2.0);
    EXPECT_EQ(odd.smallest, 1.0);
    EXPECT_EQ(odd.largest, 3.0);
    EXPECT_EQ(spread_of({4.0, 1.0, 2.0, 3.0}).median, 2.5);
}

class MessageLoopTest : public testing::Test {
protected:
    ~MessageLoopTest() override { std::filesystem::remove(file_); }
    const std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) / ("message_loop_" + std::to_string(getpid()));
};

TEST_F(MessageLoopTest, ComesBackFromAFile) {
    const MessageLoop loop{.frames = {{"header", std::string(300'000, 'x'), ""}, {"another"}}};
    write_messages(file_, loop);
    EXPECT_EQ(read_messages(file_), loop);
    EXPECT_EQ(loop.bytes(), 300'013U);
    EXPECT_EQ(loop.message_count(), 4U);
}

TEST_F(MessageLoopTest, RefusesOtherFiles) {
    write_messages(file_, {.frames = {{"header", "payload"}}});
    std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
    EXPECT_THAT([&] { read_messages(file_); }, ThrowsMessage<UserError>(HasSubstr("cut off")));
    std::ofstream(file_) << "no messages at all";
    EXPECT_THAT([&] { read_messages(file_); }, ThrowsMessage<UserError>(HasSubstr("too large")));
    write_messages(file_, {});
    EXPECT_THAT([&] { read_messages(file_); }, ThrowsMessage<UserError>(HasSubstr("no frames")));
}

} // namespace
} // namespace fieldcast::bench::fanout
