// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <draco/mesh/mesh.h>
#include <memory>
#include <optional>
#include <span>

namespace fieldcast::scene {

/// Counts that compressed data must have, and limits that it must keep.
struct DracoBounds {
    std::optional<std::uint64_t> triangles; ///< exact number; nothing: any number up to `max_triangles`
    std::uint64_t vertices = 0;             ///< exact number
    std::uint64_t max_triangles = 0;
    std::uint64_t max_bytes = 0; ///< of memory while decoding, estimated from the counts in the data
};

/// Decodes Draco data of bitstream version 2.2 that contains a triangle mesh. Counts and limits are checked before the
/// arrays of triangles and of attributes are allocated. The error names the broken rule, without an object.
Decoded<std::unique_ptr<draco::Mesh>> decode_draco(std::span<const std::byte> bytes, const DracoBounds& bounds);

} // namespace fieldcast::scene
