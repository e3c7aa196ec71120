// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/accessors.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>

namespace fieldcast::scene {

namespace {

/// Limit for accessors without buffer view. Their elements are zeros, so no byte of the file backs them.
constexpr std::uint64_t kMaxUnbackedElements = 1ULL << 20;

template <class T> T load(const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T)); // little endian, as glTF and all supported machines
    return value;
}

/// One component as a float, normalised if `is_normalised`, or as an index with its value unchanged.
template <class Out, class In> Out convert(const std::byte* bytes, bool is_normalised) {
    const In value = load<In>(bytes);
    if constexpr (std::is_same_v<Out, float> && std::is_integral_v<In>) {
        const auto real = static_cast<float>(value);
        // The clamp is for signed types, where −128 and −127 are both −1.
        return is_normalised ? std::max(real / static_cast<float>(std::numeric_limits<In>::max()), -1.0F) : real;
    } else {
        return static_cast<Out>(value);
    }
}

/// Elements of an accessor in a buffer view.
struct Elements {
    std::span<const std::byte> bytes; ///< begin at the first element
    std::uint64_t stride = 0;
    std::uint64_t count = 0;
    std::uint64_t components = 0;
    bool is_normalised = false;
};

template <class Out, class In> void copy_as(const Elements& elements, Out* out) {
    for (std::uint64_t i = 0; i < elements.count; ++i) {
        const std::byte* element = elements.bytes.data() + i * elements.stride;
        for (std::uint64_t c = 0; c < elements.components; ++c) {
            *out++ = convert<Out, In>(element + c * sizeof(In), elements.is_normalised);
        }
    }
}

template <class Out> void copy_elements(const Elements& elements, int component_type, Out* out) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return copy_as<Out, std::int8_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return copy_as<Out, std::uint8_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return copy_as<Out, std::int16_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return copy_as<Out, std::uint16_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return copy_as<Out, std::uint32_t>(elements, out);
    default:
        return copy_as<Out, float>(elements, out);
    }
}

std::uint64_t component_count(const tinygltf::Accessor& accessor) {
    return static_cast<std::uint64_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
}

std::string accessor_name(const std::string& object, int accessor) {
    return object + ": accessor " + std::to_string(accessor);
}

} // namespace

int GltfAccessors::components(int accessor) const {
    return static_cast<int>(component_count(entry(accessor)));
}

std::vector<float> GltfAccessors::read_floats(int accessor, int components, const std::string& object) {
    const int type = entry(accessor).componentType;
    if (this->components(accessor) != components || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        document_.refuse(accessor_name(object, accessor), "has the wrong type; it needs " + std::to_string(components) +
                                                              " components, each a float or of 8 or 16 bits");
    }
    std::vector<float> values = read<float>(accessor, object);
    const auto bad = std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
    if (bad != values.end()) {
        document_.refuse(accessor_name(object, accessor),
                         "element " + std::to_string((bad - values.begin()) / components) + " is not a finite number");
    }
    return values;
}

std::vector<std::uint32_t> GltfAccessors::read_indices(int accessor, const std::string& object) {
    const int type = entry(accessor).componentType;
    const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (components(accessor) != 1 || !is_unsigned) {
        document_.refuse(accessor_name(object, accessor),
                         "is not a list of indices; it needs scalars of unsigned 8, 16 or 32 bits");
    }
    return read<std::uint32_t>(accessor, object);
}

template <class T> std::vector<T> GltfAccessors::read(int accessor, const std::string& object) {
    const tinygltf::Accessor& source = entry(accessor);
    const std::uint64_t components = component_count(source);
    const std::uint64_t packed = *component_bytes(source.componentType) * components;
    if (const auto found = decoded_.find(accessor); found != decoded_.end()) {
        std::vector<T> values(source.count * components);
        copy_elements(Elements{found->second, packed, source.count, components, source.normalized},
                      source.componentType, values.data());
        return values;
    }
    if (source.bufferView < 0 && source.count > kMaxUnbackedElements) {
        document_.refuse(accessor_name(object, accessor),
                         "has more than " + std::to_string(kMaxUnbackedElements) + " elements but no buffer view");
    }
    std::vector<T> values(source.count * components);
    if (source.bufferView >= 0) {
        const auto& view = document_.model.bufferViews[static_cast<std::size_t>(source.bufferView)];
        const Elements elements{views_.bytes(source.bufferView).subspan(source.byteOffset),
                                view.byteStride == 0 ? packed : view.byteStride, source.count, components,
                                source.normalized};
        copy_elements(elements, source.componentType, values.data());
    }
    if (source.sparse.isSparse) {
        read_sparse(accessor, values, object);
    }
    return values;
}

template <class T> void GltfAccessors::read_sparse(int accessor, std::vector<T>& values, const std::string& object) {
    const tinygltf::Accessor& source = entry(accessor);
    const auto count = static_cast<std::uint64_t>(source.sparse.count);
    const std::uint64_t components = component_count(source);
    const auto elements = [&](int view, std::integral auto offset, std::uint64_t packed, std::uint64_t element_components) {
        const std::uint64_t stride = document_.model.bufferViews[static_cast<std::size_t>(view)].byteStride;
        return Elements{views_.bytes(view).subspan(static_cast<std::size_t>(offset)), stride == 0 ? packed : stride,
                        count, element_components, source.normalized};
    };
    const auto& at = source.sparse.indices;
    std::vector<std::uint32_t> targets(count);
    copy_elements(elements(at.bufferView, at.byteOffset, *component_bytes(at.componentType), 1), at.componentType,
                  targets.data());
    std::vector<T> replaced(count * components);
    copy_elements(elements(source.sparse.values.bufferView, source.sparse.values.byteOffset,
                           *component_bytes(source.componentType) * components, components),
                  source.componentType, replaced.data());
    for (std::uint64_t i = 0; i < count; ++i) {
        if (targets[i] >= source.count || (i > 0 && targets[i] <= targets[i - 1])) {
            document_.refuse(accessor_name(object, accessor), "sparse indices are out of range or not increasing; they "
                                                              "must increase and be below " +
                                                                  std::to_string(source.count));
        }
        const auto from = replaced.begin() + static_cast<std::ptrdiff_t>(i * components);
        std::copy_n(from, components, values.begin() + static_cast<std::ptrdiff_t>(targets[i] * components));
    }
}

} // namespace fieldcast::scene
