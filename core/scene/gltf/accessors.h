// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/buffer_views.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace fieldcast::scene {

/// Reads accessors as arrays, with conversion from integers, normalisation and sparse substitution. Not thread-safe.
/// Messages name `object`. Throws UserError, also if a value is not finite.
class GltfAccessors {
public:
    GltfAccessors(const GltfDocument& document, GltfBufferViews& views) : document_(document), views_(views) {}

    std::uint64_t count(int accessor) const { return entry(accessor).count; }
    int components(int accessor) const;

    /// Uses `decoded` in place of the buffer views of these accessors: packed elements, as many as the accessor has.
    /// Replaces earlier ones; an empty map ends the substitution.
    void substitute(std::map<int, std::vector<std::byte>> decoded) { decoded_ = std::move(decoded); }

    /// Values in file order, `components` per element. Refuses accessors with another number of components.
    std::vector<float> read_floats(int accessor, int components, const std::string& object);
    /// Scalars of type u8, u16 or u32.
    std::vector<std::uint32_t> read_indices(int accessor, const std::string& object);

    template <int N> std::vector<glm::vec<N, float>> read_vectors(int accessor, const std::string& object) {
        const std::vector<float> values = read_floats(accessor, N, object);
        std::vector<glm::vec<N, float>> vectors(values.size() / N);
        for (std::size_t i = 0; i < values.size(); ++i) {
            vectors[i / N][static_cast<int>(i % N)] = values[i];
        }
        return vectors;
    }

private:
    const tinygltf::Accessor& entry(int accessor) const {
        return document_.model.accessors[static_cast<std::size_t>(accessor)];
    }
    template <class T> std::vector<T> read(int accessor, const std::string& object);
    template <class T> void read_sparse(int accessor, std::vector<T>& values, const std::string& object);

    const GltfDocument& document_;
    GltfBufferViews& views_;
    std::map<int, std::vector<std::byte>> decoded_;
};

} // namespace fieldcast::scene
