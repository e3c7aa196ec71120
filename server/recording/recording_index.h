// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/recording/frame_bytes.h"

#include <optional>

namespace fieldcast::recording {

/// Position of a frame in its file.
struct IndexEntry {
    FrameMark mark;
    std::uint64_t offset = 0; ///< of its record
};

/// All frames of a file, in order.
struct RecordingIndex {
    std::vector<IndexEntry> frames{};
    std::optional<std::string> ignored{}; ///< description of the incomplete end of the file; empty: it is complete
};

/// Writes the index record at `offset`, the current end of `file`, and the end mark behind it.
void write_index(std::ostream& file, std::uint64_t offset, std::span<const IndexEntry> frames);

/// The index at the end of a finished file. Checks that all frames lie between `frames_begin` and the index.
Decoded<RecordingIndex> read_index(std::istream& file, std::uint64_t frames_begin, std::uint64_t file_bytes);

/// The index of an unfinished file, made by reading every record.
RecordingIndex scan_frames(std::istream& file, std::uint64_t frames_begin, std::uint64_t file_bytes);

} // namespace fieldcast::recording
