// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace fieldcast::image {

enum class FileFormat : std::uint8_t { kPng, kJpeg, kWebp };

/// Format and size that the first bytes of an encoded image declare.
struct ImageHeader {
    FileFormat format = FileFormat::kPng;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
};

/// Finds format and size without decoding and without allocating. Libraries allocate whole images when they open a
/// progressive JPEG or a WebP, so limits must be checked before they see the bytes. A PNG must be complete.
Decoded<ImageHeader> read_image_header(std::span<const std::byte> bytes);

} // namespace fieldcast::image
