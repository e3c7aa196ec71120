// SPDX-License-Identifier: Apache-2.0
#include "client/console.h"

#include <cstdio>
#include <unistd.h>

namespace fieldcast::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLinePeriod{3};

double discarded_percent(const play::ShownFrame& frame) {
    const auto discarded = static_cast<double>(frame.out_of_frustum + frame.id + frame.plane + frame.normal);
    return frame.view_pixels == 0 ? 0.0 : 100.0 * discarded / static_cast<double>(frame.view_pixels);
}

} // namespace

ProgressLine::ProgressLine() : is_terminal_(::isatty(STDERR_FILENO) != 0), next_(Clock::now()) {}

ProgressLine::~ProgressLine() {
    if (has_line_ && is_terminal_) {
        std::fputc('\n', stderr);
    }
}

void ProgressLine::show(const play::Progress& progress) {
    const bool is_last = progress.shown == progress.wanted;
    if (Clock::now() < next_ && !is_last) {
        return;
    }
    next_ = Clock::now() + (is_terminal_ ? std::chrono::milliseconds(kTerminalPeriod) : kLinePeriod);
    has_line_ = true;
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::fprintf(stderr, "%s", is_terminal_ ? "\r\x1b[K" : "");
    std::fprintf(stderr, "frame %llu", number(progress.shown));
    if (progress.wanted != 0) {
        std::fprintf(stderr, "/%llu", number(progress.wanted));
    }
    std::fprintf(stderr, " (id %llu)", number(progress.latest.frame_id));
    std::fprintf(stderr, "  %.2f fps  %.2f MB", progress.frames_per_second,
                 static_cast<double>(progress.latest.payload_bytes) * 1e-6);
    std::fprintf(stderr, "  discards %.2f %%", discarded_percent(progress.latest));
    if (progress.latest.pose_to_shown_ms) {
        std::fprintf(stderr, "  pose to shown %.0f ms", *progress.latest.pose_to_shown_ms);
    }
    std::fprintf(stderr, "%s", is_terminal_ ? "" : "\n");
    std::fflush(stderr);
}

} // namespace fieldcast::client
