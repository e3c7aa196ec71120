// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/codec/byte_filter.h"

#include <cstddef>
#include <span>
#include <vector>

// The body of a ZSTD_FILTERED strip. Scratch memory of the size of the pixels is kept per thread.
namespace fieldcast::codec {

/// Appends the zstd frame of the filtered pixels to `out`, or returns false if it would be no smaller than they are.
bool append_zstd(ByteFilter filter, BandSize size, std::span<const std::byte> pixels,
                 std::span<const std::byte> reference, std::vector<std::byte>& out);

/// Fills `pixels`, which has size.bytes(). On failure they are undefined.
Decoded<void> decode_zstd(ByteFilter filter, BandSize size, std::span<const std::byte> body,
                          std::span<const std::byte> reference, std::span<std::byte> pixels);

} // namespace fieldcast::codec
