// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression: one buffer view contains the geometry of a primitive, and accessors declare its counts
// and types.
#include "core/scene/gltf/draco.h"

#include "core/scene/gltf/draco_decoder.h"

#include <array>
#include <cstring>

namespace fieldcast::scene {

namespace {

/// Decodes one primitive. Indices of the extension were checked with all others of the document.
class DracoReader {
public:
    DracoReader(const GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& object)
        : document_(document), primitive_(primitive), object_(object) {}

    DracoPrimitive read(GltfBufferViews& views, std::uint64_t max_triangles) {
        const tinygltf::Value& extension = primitive_.extensions.at(kDracoExtension);
        const auto decoded = decode_draco(views.bytes(extension.Get("bufferView").GetNumberAsInt()),
                                          bounds(max_triangles, views.bytes_left()));
        if (!decoded) {
            refuse(decoded.error().message);
        }
        const draco::Mesh& mesh = **decoded;
        DracoPrimitive result;
        views.take_bytes(std::uint64_t{3} * mesh.num_faces() * sizeof(std::uint32_t), object_);
        result.corners = corners_of(mesh);
        const tinygltf::Value& attributes = extension.Get("attributes");
        for (const std::string& name : attributes.Keys()) {
            const int accessor = primitive_.attributes.at(name);
            const draco::PointAttribute& attribute = attribute_of(mesh, name, attributes.Get(name).GetNumberAsInt());
            views.take_bytes(entry(accessor).count * element_bytes(entry(accessor)), object_);
            result.accessors[accessor] = elements_of(attribute, accessor, name);
        }
        return result;
    }

private:
    [[noreturn]] void refuse(const std::string& reason) const { document_.refuse(object_, reason); }

    const tinygltf::Accessor& entry(int accessor) const {
        return document_.model.accessors[static_cast<std::size_t>(accessor)];
    }

    static std::uint64_t component_count(const tinygltf::Accessor& accessor) {
        return static_cast<std::uint64_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    }

    /// Number of vertices that indices of this type can distinguish; 0: the accessor is not for indices.
    static std::uint64_t index_range(const tinygltf::Accessor& accessor) {
        const int type = accessor.componentType;
        const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                 type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                                 type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        return is_unsigned && accessor.type == TINYGLTF_TYPE_SCALAR ? 1ULL << (8 * *component_bytes(type)) : 0;
    }

    static std::uint64_t element_bytes(const tinygltf::Accessor& accessor) {
        return component_count(accessor) * *component_bytes(accessor.componentType);
    }

    /// Draco encodes separate triangles only. So the indices of a strip have another count than the decoded mesh, and
    /// only a list's can be compared.
    DracoBounds bounds(std::uint64_t max_triangles, std::uint64_t max_bytes) const {
        DracoBounds bounds;
        bounds.vertices = entry(primitive_.attributes.at("POSITION")).count;
        bounds.max_triangles = max_triangles;
        bounds.max_bytes = max_bytes;
        if (primitive_.indices >= 0) {
            const tinygltf::Accessor& indices = entry(primitive_.indices);
            if (bounds.vertices > index_range(indices)) {
                refuse("indices: accessor " + std::to_string(primitive_.indices) + " cannot hold indices of " +
                       std::to_string(bounds.vertices) + " vertices; it needs unsigned scalars with enough bits");
            }
            if (primitive_.mode == TINYGLTF_MODE_TRIANGLES) {
                if (indices.count % 3 != 0) {
                    refuse(std::to_string(indices.count) +
                           " corners do not form triangles; a list needs a multiple of 3");
                }
                bounds.triangles = indices.count / 3;
            }
        }
        return bounds;
    }

    static std::vector<std::uint32_t> corners_of(const draco::Mesh& mesh) {
        std::vector<std::uint32_t> corners;
        corners.reserve(std::size_t{3} * mesh.num_faces());
        for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
            const draco::Mesh::Face& points = mesh.face(face);
            corners.insert(corners.end(), {points[0].value(), points[1].value(), points[2].value()});
        }
        return corners;
    }

    const draco::PointAttribute& attribute_of(const draco::Mesh& mesh, const std::string& name, int id) const {
        const draco::PointAttribute* const found = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        if (found == nullptr) {
            refuse(name + ": compressed data has no attribute with id " + std::to_string(id));
        }
        const tinygltf::Accessor& accessor = entry(primitive_.attributes.at(name));
        if (static_cast<std::uint64_t>(found->num_components()) != component_count(accessor)) {
            refuse(name + ": compressed attribute has " + std::to_string(found->num_components()) +
                   " components, but its accessor declares " + std::to_string(component_count(accessor)));
        }
        return *found;
    }

    std::vector<std::byte> elements_of(const draco::PointAttribute& attribute, int accessor,
                                       const std::string& name) const {
        switch (entry(accessor).componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convert<std::int8_t>(attribute, accessor, name);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return convert<std::uint8_t>(attribute, accessor, name);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convert<std::int16_t>(attribute, accessor, name);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return convert<std::uint16_t>(attribute, accessor, name);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return convert<std::uint32_t>(attribute, accessor, name);
        default:
            return convert<float>(attribute, accessor, name);
        }
    }

    /// Values of all vertices. Draco refuses to convert a value that is out of range of `T`.
    template <class T>
    std::vector<std::byte> convert(const draco::PointAttribute& attribute, int accessor,
                                   const std::string& name) const {
        const std::uint64_t count = entry(accessor).count;
        const std::uint64_t components = component_count(entry(accessor));
        if (count != entry(primitive_.attributes.at("POSITION")).count) {
            refuse(name + " has another length than POSITION; each vertex needs one value");
        }
        std::vector<std::byte> bytes(count * components * sizeof(T));
        std::array<T, 4> element{}; // the decoder refuses more components
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto value = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
            if (value.value() >= attribute.size() ||
                !attribute.ConvertValue(value, static_cast<std::int8_t>(components), element.data())) {
                refuse(name + ": compressed value of vertex " + std::to_string(i) +
                       " is missing or does not fit the component type of accessor " + std::to_string(accessor));
            }
            std::memcpy(&bytes[i * components * sizeof(T)], element.data(), components * sizeof(T));
        }
        return bytes;
    }

    const GltfDocument& document_;
    const tinygltf::Primitive& primitive_;
    const std::string& object_;
};

} // namespace

bool is_draco(const tinygltf::Primitive& primitive) {
    return primitive.extensions.contains(kDracoExtension);
}

DracoPrimitive read_draco(const GltfDocument& document, GltfBufferViews& views, const tinygltf::Primitive& primitive,
                          std::uint64_t max_triangles, const std::string& object) {
    return DracoReader(document, primitive, object).read(views, max_triangles);
}

} // namespace fieldcast::scene
