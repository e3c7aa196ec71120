// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/timing/frame_timing.h"

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace fieldcast::timing {

/// Empty: no such file.
struct RecorderFiles {
    std::filesystem::path frame_log; ///< .csv or .jsonl, a row per frame and client
    std::filesystem::path trace;     ///< .json, for ui.perfetto.dev

    bool any() const { return !frame_log.empty() || !trace.empty(); }
};

/// What is wrong with the names; `log_flag` and `trace_flag` are the flags that they come from.
std::optional<std::string> problem_with(const RecorderFiles& files, const std::string& log_flag,
                                        const std::string& trace_flag);

/// Writes records of frames to files, on a thread of its own: whoever adds one never waits for the disk. Memory is
/// bounded: when the disk is too slow, records are lost and counted. Files are flushed twice a second and complete when
/// this is destroyed; a trace that was cut short (the process was killed) lacks its last bracket only, which the
/// viewers accept.
class Recorder {
public:
    /// Throws UserError if a file cannot be created.
    explicit Recorder(const RecorderFiles& files);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    void add(MadeFrame frame);      ///< thread-safe, as the next
    void add(DeliveredFrame frame);

    std::uint64_t lost_count(); ///< so far

    static constexpr std::size_t kMaxWaiting = 8192; ///< records in memory

private:
    using Record = std::variant<MadeFrame, DeliveredFrame>;
    struct State {
        std::vector<Record> waiting;
        std::uint64_t lost = 0;
        bool is_ending = false;
    };
    class Files;

    void put(Record record);
    void write_loop();

    std::unique_ptr<Files> files_; ///< for the thread
    std::condition_variable changed_;
    Guarded<State> state_;
    std::jthread thread_;
};

} // namespace fieldcast::timing
