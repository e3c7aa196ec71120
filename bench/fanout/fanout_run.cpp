// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/fanout_run.h"

#include "bench/fanout/receivers.h"
#include "bench/interrupt.h"

#include <thread>

namespace fieldcast::bench::fanout {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kStartPatience{60};
constexpr std::chrono::seconds kFramePatience{60}; ///< limit for one frame on a busy machine
constexpr std::uint64_t kWarmFrames = 2;           ///< after these, the flow control windows of connections are settled

std::vector<std::string> server_arguments(const FanoutSettings& settings, const std::filesystem::path& port_file) {
    return {"--replay",      settings.recording,
            "--replay-fps",  std::to_string(settings.frames_per_second),
            "--listen",      "127.0.0.1:0",
            "--port-file",   port_file,
            "--log-level",   "warn",
            "--max-opens-per-second-per-peer", "1000"};
}

std::filesystem::path bare_program() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "fanout" / "fieldcast-bare-stream";
}

} // namespace

FanoutRun::FanoutRun(const FanoutSettings& settings) : settings_(settings) {
    const auto port_file = settings_.folder / "served.port";
    served_.emplace(settings_.server, server_arguments(settings_, port_file), port_file, kStartPatience);
    Receivers client(served_->port(), 1);
    const MessageLoop loop = client.capture(settings_.frames, settings_.frames * kFramePatience);
    const auto frames = static_cast<double>(loop.frames.size());
    megabytes_per_frame_ = static_cast<double>(loop.bytes()) / 1e6 / frames;
    messages_per_frame_ = static_cast<double>(loop.message_count()) / frames;
    const auto messages = settings_.folder / "messages";
    const auto bare_port_file = settings_.folder / "bare.port";
    write_messages(messages, loop);
    bare_.emplace(bare_program(),
                  std::vector<std::string>{messages, std::to_string(settings_.frames_per_second), bare_port_file},
                  bare_port_file, kStartPatience);
}

Round FanoutRun::run_round(const std::function<bool()>& after_sample) {
    const auto go_on = [&] {
        if (!after_sample()) {
            throw Interrupted{"no results were written"};
        }
    };
    Round round;
    for (const std::size_t clients : settings_.clients) {
        const bool is_bare_first = round_++ % 2 == 1; // alternating order, so that drift favours neither
        if (is_bare_first) {
            round.bare.push_back(measure(*bare_, clients));
            go_on();
        }
        round.served.push_back(measure(*served_, clients));
        go_on();
        if (!is_bare_first) {
            round.bare.push_back(measure(*bare_, clients));
            go_on();
        }
    }
    return round;
}

Sample FanoutRun::measure(const ServerProcess& server, std::size_t count) const {
    Receivers clients(server.port(), count);
    clients.wait_for_frames(kWarmFrames, kFramePatience);
    const auto cpu_before = server.cpu_time();
    const std::uint64_t bytes_before = clients.bytes();
    const std::uint64_t frames_before = clients.frames();
    std::this_thread::sleep_for(settings_.window);
    const std::chrono::duration<double> cpu = server.cpu_time() - cpu_before;
    return {.clients = count,
            .cpu_s = cpu.count(),
            .megabytes = static_cast<double>(clients.bytes() - bytes_before) / 1e6,
            .frames = static_cast<double>(clients.frames() - frames_before)};
}

} // namespace fieldcast::bench::fanout
