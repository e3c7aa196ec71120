// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/light_field_files.h"

#include <cstdint>
#include <filesystem>

namespace fieldcast::channel {

/// Work of `fieldcast-server render`, which writes files and does not serve.
struct OfflineJob {
    std::filesystem::path out = "out";
    std::uint32_t frame_count = 30;      ///< consecutive frames from a cold start
    bool writes_every_frame = false;     ///< each to a folder of its own; otherwise only the last frame
    std::uint32_t reference_samples = 0; ///< if > 0, also path traces the last frame's views without reuse
    image::LightFieldProducts products;
};

} // namespace fieldcast::channel
