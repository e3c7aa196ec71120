// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/image/image_header.h"
#include "core/image/rgba8.h"

#include <cstddef>
#include <span>

namespace fieldcast::image {

/// Decodes a still WebP image whose size was checked against the limits, with libwebp itself: OpenImageIO 2.4
/// multiplies the colours of WebP by alpha whatever it is asked for, and 8 bits cannot undo that.
Decoded<Rgba8> decode_webp(std::span<const std::byte> bytes, const ImageHeader& header);

} // namespace fieldcast::image
