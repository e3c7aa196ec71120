// SPDX-License-Identifier: Apache-2.0
// The real service on loopback with frames that cost nothing to render: for measurements of the way to the client.
//     synthetic_server PORT_FILE
// 30 frames a second of 64x36 pixels until INT or TERM; 36 views as they are (--codec raw) are 60 Mbit/s.
#include "core/base/stop_signals.h"
#include "server/service/grpc_server.h"
#include "tests/server/frame_time.h"
#include "tests/server/synthetic.h"

#include <fstream>
#include <iostream>
#include <thread>

namespace {

using namespace fieldcast;

constexpr float kFramesPerSecond = 30.0F;

void publish_until(const std::stop_token& stop, feed::Feed& feed) {
    WorkerPool pool(1);
    using Clock = std::chrono::steady_clock;
    auto next = Clock::now();
    for (std::uint64_t frame_id = 1; feed.wait_for_demand(stop); ++frame_id) {
        feed.publish(test::synthetic_frame(feed.info(), feed.demand(), frame_id, pool));
        next = std::max(next + std::chrono::microseconds(33'333), Clock::now());
        test::pass_frame_time(next - Clock::now());
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "synthetic_server PORT_FILE\n";
        return 2;
    }
    const StopSignals signals; // before any thread exists
    feed::ChannelInfo info = test::synthetic_info();
    info.frames_per_second = kFramesPerSecond;
    const auto feed = std::make_shared<feed::Feed>(info);
    const service::GrpcServer server({.host = "127.0.0.1", .port = 0}, {feed}, {});
    const std::jthread publisher([&](const std::stop_token& stop) { publish_until(stop, *feed); });
    std::ofstream(argv[1]) << server.port() << '\n';
    while (!signals.wait(std::chrono::hours(1))) {
    }
    return 0;
}
