// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"
#include "server/recording/recording_index.h"

#include <chrono>
#include <filesystem>
#include <fstream>

namespace fieldcast::recording {

/// Writes frames of a channel to a file, one record each: if the process is killed, the file can be read up to its
/// last complete frame. Not thread-safe.
class RecordingWriter {
public:
    /// Replaces the file. `info.recorded` lists the selections to record; the scene bundle is written if one of them
    /// has planes. Throws UserError if the file cannot be written.
    RecordingWriter(const std::filesystem::path& file, const feed::ChannelInfo& info);
    ~RecordingWriter(); ///< calls `finish`; problems are logged

    /// Writes `frame`, shown at `at` (any origin). False: it lacks a recorded selection and was left out. If its key
    /// frame is not in the file, only strips that stand alone are written. Throws std::runtime_error if writing fails.
    bool add(const feed::EncodedFrame& frame, std::chrono::nanoseconds at);

    /// Writes the index; no frame can be added afterwards. Throws std::runtime_error if writing fails.
    void finish();

    std::size_t frame_count() const { return frames_.size(); }
    std::uint64_t file_bytes() const { return file_bytes_; }

private:
    bool can_hold(const feed::EncodedFrame& frame) const;
    void flush(const char* what);

    std::filesystem::path path_;
    std::ofstream file_;
    std::vector<feed::Selection> recorded_;
    feed::Demand demand_; ///< union of the recorded selections
    std::vector<IndexEntry> frames_;
    std::chrono::nanoseconds begin_{0};
    std::uint64_t last_key_id_ = 0; ///< last key frame in the file; 0: none yet
    std::uint64_t file_bytes_ = 0;
    bool is_finished_ = false;
};

} // namespace fieldcast::recording
