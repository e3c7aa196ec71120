// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"
#include "server/recording/recording_index.h"

#include <filesystem>
#include <fstream>

namespace fieldcast::recording {

/// A recorded channel on disk; docs/recordings.md has the format. Not thread-safe.
///
///     Recording recording("hall.fcrec");
///     for (std::size_t i = 0; i < recording.frames().size(); ++i) { auto frame = recording.read(i); … }
class Recording {
public:
    /// Throws UserError naming the place if the file is not a recording, or has no complete frame. An unfinished file
    /// is read up to its last complete frame.
    explicit Recording(const std::filesystem::path& file);

    /// The recorded channel; every frame has all selections in `recorded`.
    const feed::ChannelInfo& info() const { return info_; }

    const std::vector<IndexEntry>& frames() const { return index_.frames; }

    /// Description of the ignored end of an unfinished file; empty: the file was finished.
    const std::optional<std::string>& ignored() const { return index_.ignored; }

    /// Frame `i` as it was recorded; fails if its record is damaged.
    Decoded<feed::EncodedFrame> read(std::size_t i);

private:
    void read_channel();
    void read_index_or_scan();

    std::filesystem::path path_;
    std::ifstream file_;
    std::uint64_t file_bytes_ = 0;
    std::uint64_t frames_begin_ = 0;
    feed::ChannelInfo info_;
    feed::Demand demand_; ///< union of the recorded selections
    RecordingIndex index_;
};

} // namespace fieldcast::recording
