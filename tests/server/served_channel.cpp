// SPDX-License-Identifier: Apache-2.0
#include "tests/server/served_channel.h"

#include "tests/fixtures/polling.h"

namespace fieldcast::test {

namespace {

using namespace std::chrono_literals;
constexpr auto kPatience = 60s; // of a test on a busy machine; deadlines of the server are far below

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
    if (comes_true([&] { return metric(series) == value; }, kPatience)) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << series << " is not " << value << " in\n" << page();
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
            ++*frames_.lock();
            came_.notify_all();
        }
    }
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

testing::AssertionResult Bystander::gets_more_frames() {
    constexpr std::uint64_t kSome = 5; // more than it may have unacknowledged
    auto frames = frames_.lock();
    const std::uint64_t wanted = *frames + kSome;
    if (frames.wait_until(came_, std::chrono::steady_clock::now() + kPatience,
                          [&](std::uint64_t count) { return count >= wanted; })) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << "a client that behaves has got " << *frames << " frames";
}

} // namespace fieldcast::test
