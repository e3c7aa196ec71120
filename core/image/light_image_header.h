// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace fieldcast::image {

enum class LightFormat : std::uint8_t { kRadiance, kOpenExr };

/// Bytes at the beginning of a file that hold the header of every image that we take.
inline constexpr std::size_t kLightHeaderBytes = 1U << 20;

/// Looks at the beginning of a .hdr or .exr file (all of it, or kLightHeaderBytes) of `file_bytes` before a library
/// does: OpenEXR allocates what the header claims before it reads on, and OpenImageIO would try every format it knows.
/// Afterwards nothing that the header claims is larger than the file or than `max_pixels` allow. Radiance files are
/// only recognised: their size is read without allocating.
Decoded<LightFormat> read_light_image_header(std::span<const std::byte> beginning, std::uint64_t file_bytes,
                                             std::uint64_t max_pixels);

} // namespace fieldcast::image
