// SPDX-License-Identifier: Apache-2.0
#include "core/timing/timing_recorder.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/timing/log_text.h"
#include "core/timing/trace_text.h"

#include <chrono>
#include <fstream>
#include <utility>

namespace fieldcast::timing {

namespace {

constexpr std::chrono::milliseconds kFlushInterval{500};

std::ofstream create(const std::filesystem::path& file) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    if (!stream) {
        throw UserError(file.string() + ": cannot be created; check that its folder exists and is writable");
    }
    return stream;
}

} // namespace

std::optional<std::string> problem_with(const TimingFiles& files, const std::string& log_flag,
                                        const std::string& trace_flag) {
    const std::string log_end = files.frame_log.extension().string();
    if (!files.frame_log.empty() && log_end != ".csv" && log_end != ".jsonl") {
        return log_flag + " " + files.frame_log.string() +
               ": the name must end in .csv or .jsonl, which selects the format";
    }
    if (!files.trace.empty() && files.trace.extension() != ".json") {
        return trace_flag + " " + files.trace.string() + ": the name must end in .json";
    }
    return std::nullopt;
}

class TimingRecorder::Files {
public:
    explicit Files(const TimingFiles& files) : is_csv_(files.frame_log.extension() == ".csv") {
        if (!files.frame_log.empty()) {
            log_.emplace(create(files.frame_log));
            *log_ << (is_csv_ ? csv_header() : "");
        }
        if (!files.trace.empty()) {
            trace_.emplace(create(files.trace));
            *trace_ << TraceText::begin();
        }
    }

    void write(const MadeFrame& frame) {
        if (trace_) {
            *trace_ << text_.events_of(frame);
        }
    }

    void write(const DeliveredFrame& frame) {
        if (log_) {
            *log_ << (is_csv_ ? to_csv(frame) : to_json_line(frame));
        }
        if (trace_) {
            *trace_ << text_.events_of(frame);
        }
    }

    void flush() {
        const bool is_well = (!log_ || log_->flush()) && (!trace_ || trace_->flush());
        if (!is_well && !std::exchange(has_failed_, true)) {
            log::error("timing records cannot be written", {});
        }
    }

    void finish() {
        if (trace_) {
            *trace_ << TraceText::end();
        }
        flush();
    }

private:
    bool is_csv_;
    bool has_failed_ = false;
    std::optional<std::ofstream> log_;
    std::optional<std::ofstream> trace_;
    TraceText text_;
};

TimingRecorder::TimingRecorder(const TimingFiles& files)
    : files_(std::make_unique<Files>(files)), thread_([this] { write_loop(); }) {}

TimingRecorder::~TimingRecorder() {
    state_.lock()->is_ending = true;
    changed_.notify_all();
    thread_.join();
    if (const std::uint64_t lost = lost_count(); lost > 0) {
        log::warn("timing records lost", {{"count", lost}});
    }
}

void TimingRecorder::add(MadeFrame frame) {
    put(std::move(frame));
}

void TimingRecorder::add(DeliveredFrame frame) {
    put(std::move(frame));
}

void TimingRecorder::put(Record record) {
    auto state = state_.lock();
    if (state->waiting.size() >= kMaxWaiting) {
        ++state->lost;
        return;
    }
    state->waiting.push_back(std::move(record)); // no notification: the thread polls twice a second
}

std::uint64_t TimingRecorder::lost_count() {
    return state_.lock()->lost;
}

void TimingRecorder::write_loop() {
    bool is_ending = false;
    while (!is_ending) {
        std::vector<Record> records;
        {
            auto state = state_.lock();
            state.wait_until(changed_, std::chrono::steady_clock::now() + kFlushInterval,
                             [](const State& s) { return s.is_ending; });
            records = std::exchange(state->waiting, {});
            is_ending = state->is_ending;
        }
        for (const Record& record : records) {
            std::visit([&](const auto& frame) { files_->write(frame); }, record);
        }
        files_->flush();
    }
    files_->finish();
}

} // namespace fieldcast::timing
