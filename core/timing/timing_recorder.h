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

/// Names of the files; a file with an empty name is not written.
struct TimingFiles {
    std::filesystem::path frame_log; ///< .csv or .jsonl, a row per frame and client
    std::filesystem::path trace;     ///< .json, for ui.perfetto.dev

    bool any() const { return !frame_log.empty() || !trace.empty(); }
};

/// The problem with the names, if there is one; `log_flag` and `trace_flag` are the flags that set them.
std::optional<std::string> problem_with(const TimingFiles& files, const std::string& log_flag,
                                        const std::string& trace_flag);

/// Writes timing records of frames to files, on a thread of its own: callers of add() never wait for the disk. Memory
/// is bounded: when the disk is too slow, records are lost and counted. Files are flushed twice a second, and they are
/// complete after the destructor. The trace of a process that was killed lacks only its last bracket, which the viewers
/// accept.
class TimingRecorder {
public:
    /// Throws UserError if a file cannot be created.
    explicit TimingRecorder(const TimingFiles& files);
    ~TimingRecorder();
    TimingRecorder(const TimingRecorder&) = delete;
    TimingRecorder& operator=(const TimingRecorder&) = delete;

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
