// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace fieldcast::channel {

/// Work of `fieldcast-server record`, which writes a recording and does not serve. Its forms are in Settings.
struct RecordJob {
    std::filesystem::path out = "recording.fcrec";
    std::uint32_t frame_count = 30; ///< consecutive frames from a cold start, 1/fps apart
};

} // namespace fieldcast::channel
