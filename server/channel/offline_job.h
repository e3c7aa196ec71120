// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/light_field_files.h"

#include <cstdint>
#include <filesystem>

namespace fieldcast::channel {

/// What `fieldcast-server render` makes: files instead of a service.
struct OfflineJob {
    std::filesystem::path out = "out";
    std::uint32_t frame_count = 30;      ///< rendered one after the other, from a cold start
    bool writes_every_frame = false;     ///< each to a folder of its own; otherwise the last
    std::uint32_t reference_samples = 0; ///< > 0: views of the last frame path traced with so many, nothing reused
    image::LightFieldProducts products;
};

} // namespace fieldcast::channel
