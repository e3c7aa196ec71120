// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/recording/frame_bytes.h"

#include <optional>

namespace fieldcast::recording {

/// Where a frame stands in its file.
struct IndexEntry {
    FrameMark mark;
    std::uint64_t offset = 0; ///< of its record
};

/// All frames of a file, in order.
struct RecordingIndex {
    std::vector<IndexEntry> frames{};
    std::optional<std::string> ignored{}; ///< what stands at the end and is not complete; nothing if all is well
};

/// The index record and what ends a file behind it.
void write_index(std::ostream& file, std::uint64_t offset, std::span<const IndexEntry> frames);

/// The index at the end of a file, if it was finished; checked against a file whose frames begin at `frames_begin`.
Decoded<RecordingIndex> read_index(std::istream& file, std::uint64_t frames_begin, std::uint64_t file_bytes);

/// The same, found by looking at every record: for files that were not finished.
RecordingIndex scan_frames(std::istream& file, std::uint64_t frames_begin, std::uint64_t file_bytes);

} // namespace fieldcast::recording
