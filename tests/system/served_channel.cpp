// SPDX-License-Identifier: Apache-2.0
#include "served_channel.h"

namespace fieldcast::test {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = 15s; // of a test on a busy machine; deadlines of the server are far below

} // namespace

ServedChannel::ServedChannel(const session::Limits& limits)
    : server_({.host = "127.0.0.1", .port = 0}, {channel_.feed()}, limits, {}, {.registry = registry_}) {}

double ServedChannel::metric(const std::string& series) {
    std::string text("\n");
    text += page();
    const std::size_t line = text.find("\n" + series + " ");
    return line == std::string::npos ? -1.0 : std::stod(text.substr(line + series.size() + 2));
}

testing::AssertionResult ServedChannel::shows(const std::string& series, double value) {
    const auto deadline = Clock::now() + kPatience;
    while (metric(series) != value) {
        if (Clock::now() >= deadline) {
            return testing::AssertionFailure() << series << " is not " << value << " in\n" << page();
        }
        std::this_thread::sleep_for(10ms); // a page has no event to wait for
    }
    return testing::AssertionSuccess();
}

Bystander::Bystander(int port)
    : connection_(connect(port)), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

Bystander::~Bystander() {
    thread_ = {}; // stops and joins
}

void Bystander::watch(const std::stop_token& stop) {
    OpenCall call(connection_);
    call.configure();
    while (!stop.stop_requested()) {
        const auto message = call.read();
        if (!message) {
            ADD_FAILURE() << "a client that behaves was cut: " << call.finish().error_message();
            return;
        }
        if (message->frame_chunk().has_trailer()) {
            call.acknowledge(message->frame_chunk());
            ++frames_;
        }
    }
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

testing::AssertionResult Bystander::gets_more_frames() {
    constexpr std::uint64_t kSome = 5; // more than it may have unacknowledged
    const std::uint64_t wanted = frames_ + kSome;
    const auto deadline = Clock::now() + kPatience;
    while (frames_ < wanted) {
        if (Clock::now() >= deadline) {
            return testing::AssertionFailure() << "a client that behaves has got " << frames_ << " frames";
        }
        std::this_thread::sleep_for(5ms);
    }
    return testing::AssertionSuccess();
}

} // namespace fieldcast::test
