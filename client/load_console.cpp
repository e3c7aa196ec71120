// SPDX-License-Identifier: Apache-2.0
#include "client/load_console.h"

#include <cstdio>
#include <unistd.h>

namespace fieldcast::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLinePeriod{5};

unsigned long long number(std::uint64_t value) {
    return value;
}

void print_heading(const load::LoadProgress& progress) {
    std::fprintf(stderr, "\x1b[K%s %.0f", progress.is_ramp ? "starting" : "measuring", progress.seconds);
    if (progress.of_seconds > 0.0) {
        std::fprintf(stderr, " of %.0f", progress.of_seconds);
    }
    std::fprintf(stderr, " s\n\x1b[K%-18s %11s %8s %8s %9s %9s %9s %7s %7s\n", "group", "connected", "fps", "MB/s",
                 "frames", "due p50", "due p99", "failed", "lost");
}

void print_row(const load::LoadProgress::GroupLine& line) {
    std::fprintf(stderr, "\x1b[K%-18.18s %5lld/%-5u %8.1f %8.2f %9llu %9.1f %9.1f %7llu %7llu\n", line.name.c_str(),
                 static_cast<long long>(line.connected), line.clients, line.fps, line.megabytes_per_second,
                 number(line.frames), line.due_p50_ms, line.due_p99_ms, number(line.failed), number(line.lost));
}

void print_line(const load::LoadProgress& progress, const load::LoadProgress::GroupLine& line) {
    std::fprintf(stderr, "%s %.0f s, %s: %lld of %u connected, %.1f fps, %.2f MB/s, due %.1f ms p50, %.1f ms p99, "
                         "%llu failed, %llu lost\n",
                 progress.is_ramp ? "starting" : "measuring", progress.seconds, line.name.c_str(),
                 static_cast<long long>(line.connected), line.clients, line.fps, line.megabytes_per_second,
                 line.due_p50_ms, line.due_p99_ms, number(line.failed), number(line.lost));
}

} // namespace

LoadConsole::LoadConsole() : is_terminal_(::isatty(STDERR_FILENO) != 0), next_(Clock::now()) {}

void LoadConsole::show(const load::LoadProgress& progress) {
    if (!is_terminal_ && Clock::now() < next_) {
        return;
    }
    next_ = Clock::now() + kLinePeriod;
    if (is_terminal_) {
        if (lines_ > 0) {
            std::fprintf(stderr, "\x1b[%zuA", lines_); // up to the heading
        }
        print_heading(progress);
        lines_ = progress.groups.size() + 2;
    }
    for (const load::LoadProgress::GroupLine& line : progress.groups) {
        if (is_terminal_) {
            print_row(line);
        } else {
            print_line(progress, line);
        }
    }
    std::fflush(stderr);
}

} // namespace fieldcast::client
