// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"
#include "server/recording/recording_index.h"

#include <chrono>
#include <filesystem>
#include <fstream>

namespace fieldcast::recording {

/// Writes frames of a channel to a file, each whole or not at all: a file whose writer is killed can be read up to its
/// last frame. Not thread-safe.
class RecordingWriter {
public:
    /// Replaces the file. `info.recorded` says what to record; the bundle is written if planes are among it. Throws
    /// UserError if the file cannot be written.
    RecordingWriter(const std::filesystem::path& file, const feed::ChannelInfo& info);
    ~RecordingWriter(); ///< finishes; problems are logged

    /// Writes `frame`, shown at `at` (any origin), unless it lacks something that is recorded: false. If its key frame
    /// is not in the file, its strips refer to nothing. Throws std::runtime_error if the disk refuses.
    bool add(const feed::EncodedFrame& frame, std::chrono::nanoseconds at);

    /// Writes the index; nothing can be added any more. Throws std::runtime_error if the disk refuses.
    void finish();

    std::size_t frame_count() const { return frames_.size(); }
    std::uint64_t file_bytes() const { return file_bytes_; }

private:
    bool can_hold(const feed::EncodedFrame& frame) const;
    void flush(const char* what);

    std::filesystem::path path_;
    std::ofstream file_;
    std::vector<feed::Selection> recorded_;
    feed::Demand demand_; ///< the union of what is recorded
    std::vector<IndexEntry> frames_;
    std::chrono::nanoseconds begin_{0};
    std::uint64_t last_key_id_ = 0; ///< that is in the file; 0: none yet
    std::uint64_t file_bytes_ = 0;
    bool is_finished_ = false;
};

} // namespace fieldcast::recording
