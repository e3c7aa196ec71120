// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/document.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace fieldcast::scene {

/// Bytes of buffer views; those with EXT_meshopt_compression are decoded on first use. Counts all decompressed bytes.
/// Not thread-safe.
class GltfBufferViews {
public:
    /// Keeps a reference to `document`. `max_decoded_bytes`: limit for all decompressed data together.
    GltfBufferViews(const GltfDocument& document, std::uint64_t max_decoded_bytes)
        : document_(document), bytes_left_(max_decoded_bytes) {}

    /// The view's bytes, byteLength of them. Throws UserError.
    std::span<const std::byte> bytes(int view);

    /// Number of bytes that may still be decompressed.
    std::uint64_t bytes_left() const { return bytes_left_; }
    /// Counts `size` decompressed bytes of `object` before they are allocated. Throws UserError if they are too many.
    void take_bytes(std::uint64_t size, const std::string& object);

private:
    std::span<const std::byte> decoded_bytes(int view);

    const GltfDocument& document_;
    std::map<int, std::vector<std::byte>> decoded_;
    std::uint64_t bytes_left_;
};

} // namespace fieldcast::scene
