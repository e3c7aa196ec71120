// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace fieldcast::channel {

/// What `fieldcast-server record` makes: a recording instead of a service. Its forms stand in the configuration.
struct RecordJob {
    std::filesystem::path out = "recording.fcrec";
    std::uint32_t frame_count = 30; ///< rendered one after the other, 1/fps apart, from a cold start
};

} // namespace fieldcast::channel
