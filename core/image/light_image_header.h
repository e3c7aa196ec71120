// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace fieldcast::image {

enum class LightFormat : std::uint8_t { kRadiance, kOpenExr };

/// Size of the beginning of a file, which contains the header of every image that is accepted.
inline constexpr std::size_t kLightHeaderBytes = 1U << 20;

/// Checks the beginning of a .hdr or .exr file (all of it, or kLightHeaderBytes) of `file_bytes` before a library reads
/// it: OpenEXR allocates what the header declares before it reads on, and OpenImageIO would try every format it knows.
/// On success, nothing that the header declares is larger than the file or than `max_pixels` allow. Radiance files are
/// only recognised, because reading their size allocates nothing.
Decoded<LightFormat> read_light_image_header(std::span<const std::byte> beginning, std::uint64_t file_bytes,
                                             std::uint64_t max_pixels);

} // namespace fieldcast::image
