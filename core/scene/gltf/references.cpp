// SPDX-License-Identifier: Apache-2.0
// Checks every index and range of a glTF file, because tinygltf checks none of them.
#include "core/scene/gltf/document.h"

#include "core/scene/gltf/draco.h"

#include <concepts>
#include <optional>

namespace fieldcast::scene {

namespace {

constexpr std::uint64_t kMaxStride = 252;

class ReferenceCheck {
public:
    explicit ReferenceCheck(const GltfDocument& document) : document_(document), model_(document.model) {}

    void run() const {
        for (std::size_t i = 0; i < model_.bufferViews.size(); ++i) {
            check_view(model_.bufferViews[i], object_name("bufferView", i, model_.bufferViews[i].name));
        }
        for (std::size_t i = 0; i < model_.accessors.size(); ++i) {
            check_accessor(model_.accessors[i], object_name("accessor", i, model_.accessors[i].name));
        }
        for (std::size_t i = 0; i < model_.meshes.size(); ++i) {
            check_mesh(model_.meshes[i], object_name("mesh", i, model_.meshes[i].name));
        }
        for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
            check_node(model_.nodes[i], object_name("node", i, model_.nodes[i].name));
        }
        for (std::size_t i = 0; i < model_.animations.size(); ++i) {
            check_animation(model_.animations[i], object_name("animation", i, model_.animations[i].name));
        }
        check_textures();
        check_scenes();
    }

private:
    void check_index(int index, std::size_t count, const std::string& object, const std::string& what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= count) {
            document_.refuse(object, what + " " + std::to_string(index) + " does not exist; the file has " +
                                         std::to_string(count));
        }
    }

    /// Like check_index(), but accepts −1, which means absent.
    void check_optional(int index, std::size_t count, const std::string& object, const std::string& what) const {
        if (index != -1) {
            check_index(index, count, object, what);
        }
    }

    void check_view(const tinygltf::BufferView& view, const std::string& object) const {
        check_index(view.buffer, document_.buffers.size(), object, "buffer");
        const GltfBuffer& buffer = document_.buffers[static_cast<std::size_t>(view.buffer)];
        const std::uint64_t end = view.byteOffset + view.byteLength; // both at most 2⁵³
        if (view.byteLength == 0 || end > buffer.byte_length) {
            document_.refuse(object, "ends at byte " + std::to_string(end) + " of a buffer of " +
                                         std::to_string(buffer.byte_length) + " bytes");
        }
        if (view.byteStride > kMaxStride) {
            document_.refuse(object, "byteStride is greater than 252, the limit of glTF");
        }
    }

    /// Checks `count` elements of `element_bytes` bytes, `stride` apart, from `offset` in a view.
    void check_range(int view_index, std::uint64_t offset, std::uint64_t count, std::uint64_t element_bytes,
                     const std::string& object) const {
        check_index(view_index, model_.bufferViews.size(), object, "bufferView");
        const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(view_index)];
        const std::uint64_t stride = view.byteStride == 0 ? element_bytes : view.byteStride;
        if (stride < element_bytes) {
            document_.refuse(object, "elements are larger than the stride of bufferView " + std::to_string(view_index));
        }
        // Offset and count are at most 2⁵³ and sizes at most 2⁸, so 64 bits do not overflow.
        const std::uint64_t end = offset + (count - 1) * stride + element_bytes;
        if (end > view.byteLength) {
            document_.refuse(object, "ends " + std::to_string(end - view.byteLength) + " bytes beyond bufferView " +
                                         std::to_string(view_index));
        }
    }

    void check_accessor(const tinygltf::Accessor& accessor, const std::string& object) const {
        const std::optional<std::uint64_t> component = component_bytes(accessor.componentType);
        if (!component) {
            document_.refuse(object, "unknown componentType " + std::to_string(accessor.componentType) +
                                         "; expected 5120 to 5123, 5125 or 5126");
        }
        if (accessor.count == 0) {
            document_.refuse(object, "has no elements; its count must be at least 1");
        }
        const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
        const std::uint64_t element = *component * static_cast<std::uint64_t>(components);
        if (accessor.bufferView != -1) {
            check_range(accessor.bufferView, accessor.byteOffset, accessor.count, element, object);
        }
        if (accessor.sparse.isSparse) {
            check_sparse(accessor, element, object);
        }
    }

    void check_sparse(const tinygltf::Accessor& accessor, std::uint64_t element, const std::string& object) const {
        const auto& sparse = accessor.sparse;
        if (sparse.count < 1 || static_cast<std::uint64_t>(sparse.count) > accessor.count) {
            document_.refuse(object, "sparse count " + std::to_string(sparse.count) +
                                         " is out of range; expected 1 to " + std::to_string(accessor.count));
        }
        const int type = sparse.indices.componentType;
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
            type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
            document_.refuse(object, "sparse indices have componentType " + std::to_string(type) +
                                         "; expected 5121, 5123 or 5125");
        }
        const auto count = static_cast<std::uint64_t>(sparse.count);
        // Offsets are not negative, as the checks of the JSON ensure.
        const auto offset_of = [](std::integral auto offset) { return static_cast<std::uint64_t>(offset); };
        check_range(sparse.indices.bufferView, offset_of(sparse.indices.byteOffset), count, *component_bytes(type),
                    object + " (sparse indices)");
        check_range(sparse.values.bufferView, offset_of(sparse.values.byteOffset), count, element,
                    object + " (sparse values)");
    }

    void check_mesh(const tinygltf::Mesh& mesh, const std::string& object) const {
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            const std::string name = object + ": primitive " + std::to_string(i);
            for (const auto& [attribute, accessor] : primitive.attributes) {
                check_index(accessor, model_.accessors.size(), name, "accessor");
            }
            check_optional(primitive.indices, model_.accessors.size(), name, "accessor");
            check_optional(primitive.material, model_.materials.size(), name, "material");
            if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
                document_.refuse(name, "unknown mode " + std::to_string(primitive.mode) + "; expected 0 to 6");
            }
            check_draco(primitive, name);
        }
    }

    /// Members of KHR_draco_mesh_compression have the right types, as the checks of the JSON ensure, if they exist.
    void check_draco(const tinygltf::Primitive& primitive, const std::string& object) const {
        if (!is_draco(primitive)) {
            return;
        }
        const tinygltf::Value& extension = primitive.extensions.at(kDracoExtension);
        if (!extension.Has("bufferView") || !extension.Has("attributes")) {
            document_.refuse(object, std::string(kDracoExtension) + " needs a bufferView and attributes");
        }
        check_index(extension.Get("bufferView").GetNumberAsInt(), model_.bufferViews.size(), object,
                    "compressed bufferView");
        for (const std::string& attribute : extension.Get("attributes").Keys()) {
            if (!primitive.attributes.contains(attribute)) {
                document_.refuse(object, "compressed attribute '" + attribute.substr(0, 60) +
                                             "' is not an attribute of the primitive; each must be one");
            }
        }
        if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP) {
            document_.refuse(object, "compressed primitive has mode " + std::to_string(primitive.mode) +
                                         "; expected 4 or 5, triangles or a strip");
        }
    }

    void check_node(const tinygltf::Node& node, const std::string& object) const {
        check_optional(node.mesh, model_.meshes.size(), object, "mesh");
        check_optional(node.camera, model_.cameras.size(), object, "camera");
        check_optional(node.skin, document_.skin_count, object, "skin");
        for (const int child : node.children) {
            check_index(child, model_.nodes.size(), object, "child node");
        }
        const auto light = node.extensions.find("KHR_lights_punctual");
        if (light != node.extensions.end()) {
            const int index = light->second.Has("light") ? light->second.Get("light").GetNumberAsInt() : -1;
            check_index(index, model_.lights.size(), object, "light");
        }
    }

    void check_animation(const tinygltf::Animation& animation, const std::string& object) const {
        for (const tinygltf::AnimationSampler& sampler : animation.samplers) {
            check_index(sampler.input, model_.accessors.size(), object, "accessor");
            check_index(sampler.output, model_.accessors.size(), object, "accessor");
        }
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            check_index(channel.sampler, animation.samplers.size(), object, "sampler");
            check_index(channel.target_node, model_.nodes.size(), object, "node");
        }
    }

    void check_textures() const {
        for (std::size_t i = 0; i < model_.textures.size(); ++i) {
            const std::string object = object_name("texture", i, model_.textures[i].name);
            check_optional(model_.textures[i].source, document_.images.size(), object, "image");
            check_optional(model_.textures[i].sampler, model_.samplers.size(), object, "sampler");
        }
        for (const GltfImage& image : document_.images) {
            check_optional(image.buffer_view, model_.bufferViews.size(), image.name, "bufferView");
        }
    }

    void check_scenes() const {
        check_optional(model_.defaultScene, model_.scenes.size(), "json", "scene");
        for (std::size_t i = 0; i < model_.scenes.size(); ++i) {
            for (const int node : model_.scenes[i].nodes) {
                check_index(node, model_.nodes.size(), object_name("scene", i, model_.scenes[i].name), "node");
            }
        }
    }

    const GltfDocument& document_;
    const tinygltf::Model& model_;
};

} // namespace

std::optional<std::uint64_t> component_bytes(int component_type) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return std::nullopt;
    }
}

void check_gltf_references(const GltfDocument& document) {
    ReferenceCheck(document).run();
}

} // namespace fieldcast::scene
