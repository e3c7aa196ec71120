// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf_document.h"

#include <cstddef>
#include <map>
#include <span>
#include <vector>

namespace fieldcast::scene {

/// Bytes of buffer views; those with EXT_meshopt_compression are decoded on first use. Not thread-safe.
class GltfBufferViews {
public:
    /// Keeps a reference to `document`.
    explicit GltfBufferViews(const GltfDocument& document) : document_(document) {}

    /// As long as the view's byteLength. Throws UserError.
    std::span<const std::byte> bytes(int view);

private:
    std::span<const std::byte> decoded_bytes(int view);

    const GltfDocument& document_;
    std::map<int, std::vector<std::byte>> decoded_;
};

} // namespace fieldcast::scene
