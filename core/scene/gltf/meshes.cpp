// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/meshes.h"

#include "core/scene/gltf/draco.h"
#include "core/scene/gltf/numbers.h"
#include "core/scene/mesh_normals.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace fieldcast::scene {

namespace {

/// The scene's meshes of one glTF mesh: the first one and their number. Each is a primitive of triangles.
struct MeshRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

class MeshReader {
public:
    MeshReader(GltfDocument& document, GltfBufferViews& views, GltfAccessors& accessors, const SceneLimits& limits)
        : document_(document), views_(views), accessors_(accessors), limits_(limits) {}

    GltfMeshes read(const GltfNodes& nodes) {
        for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
            const tinygltf::Node& node = file_node(document_, nodes, i);
            if (node.skin >= 0) {
                document_.warnings.add("skins are ignored", "node");
            }
            if (node.mesh >= 0) {
                add_instances(static_cast<std::uint32_t>(i), mesh_range(node.mesh));
            }
        }
        return std::move(result_);
    }

private:
    void add_instances(std::uint32_t node, const MeshRange& range) {
        if (result_.instances.size() + range.count > kMaxInstances) {
            document_.refuse("nodes", "place more than " + std::to_string(kMaxInstances) +
                                          " instances of primitives, the limit; merge meshes");
        }
        for (std::uint32_t i = 0; i < range.count; ++i) {
            result_.instances.push_back({node, range.first + i});
        }
    }

    MeshRange mesh_range(int mesh) {
        if (const auto found = ranges_.find(mesh); found != ranges_.end()) {
            return found->second;
        }
        const tinygltf::Mesh& source = document_.model.meshes[static_cast<std::size_t>(mesh)];
        const std::string object = object_name("mesh", static_cast<std::size_t>(mesh), source.name);
        MeshRange range{static_cast<std::uint32_t>(result_.meshes.size()), 0};
        for (std::size_t i = 0; i < source.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = source.primitives[i];
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                document_.warnings.add("points and lines are ignored", "primitive");
                continue;
            }
            result_.meshes.push_back(read_primitive(primitive, object + ": primitive " + std::to_string(i)));
            result_.meshes.back().name = source.name;
            ++range.count;
        }
        ranges_.emplace(mesh, range);
        return range;
    }

    Mesh read_primitive(const tinygltf::Primitive& primitive, const std::string& object) {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) {
            document_.refuse(object, "has no POSITION, which every primitive needs");
        }
        const std::uint64_t vertex_count = accessors_.count(position->second);
        std::vector<std::uint32_t> corners; // of separate triangles, if the primitive is compressed
        if (is_draco(primitive)) {
            corners = decompress(primitive, vertex_count, object);
        } else {
            reserve_budget(triangle_bound(primitive, vertex_count), vertex_count, object);
        }
        Mesh mesh;
        mesh.material = primitive.material >= 0 ? static_cast<std::uint32_t>(primitive.material)
                                                : static_cast<std::uint32_t>(document_.model.materials.size());
        mesh.positions = read_attribute<3>(primitive, "POSITION", vertex_count, object);
        mesh.normals = read_attribute<3>(primitive, "NORMAL", vertex_count, object);
        mesh.tangents = read_attribute<4>(primitive, "TANGENT", vertex_count, object);
        mesh.uv0 = read_coordinates(primitive, "TEXCOORD_0", vertex_count, object);
        mesh.uv1 = read_coordinates(primitive, "TEXCOORD_1", vertex_count, object);
        mesh.colours = read_colours(primitive, vertex_count, object);
        mesh.triangles =
            is_draco(primitive)
                ? triangles_of(TINYGLTF_MODE_TRIANGLES, corners, vertex_count, object)
                : triangles_of(primitive.mode, read_corners(primitive, vertex_count, object), vertex_count, object);
        accessors_.substitute({});
        if (mesh.normals.empty()) {
            mesh.tangents.clear(); // glTF: without normals, tangents must be ignored
            make_flat_normals(mesh);
        }
        normalise_frames(mesh);
        if (!primitive.targets.empty()) {
            document_.warnings.add("morph targets are ignored", "primitive");
        }
        return mesh;
    }

    std::uint64_t triangle_bound(const tinygltf::Primitive& primitive, std::uint64_t vertex_count) const {
        const std::uint64_t corners = primitive.indices >= 0 ? accessors_.count(primitive.indices) : vertex_count;
        return primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
    }

    /// Makes the accessors of a compressed primitive return its decoded attributes. Returns its triangles' corners.
    std::vector<std::uint32_t> decompress(const tinygltf::Primitive& primitive, std::uint64_t vertex_count,
                                          const std::string& object) {
        reserve_budget(0, vertex_count, object);
        DracoPrimitive decoded =
            read_draco(document_, views_, primitive, limits_.max_triangles - triangle_count_, object);
        reserve_budget(decoded.corners.size() / 3, 0, object);
        accessors_.substitute(std::move(decoded.accessors));
        return std::move(decoded.corners);
    }

    /// Counts triangles and vertices before they are allocated, because many primitives may share the same few bytes.
    void reserve_budget(std::uint64_t triangle_count, std::uint64_t vertex_count, const std::string& object) {
        triangle_count_ += triangle_count;
        vertex_count_ += vertex_count;
        if (triangle_count_ > limits_.max_triangles || vertex_count_ / 3 > limits_.max_triangles) {
            document_.refuse(object, "brings the scene to more than " + std::to_string(limits_.max_triangles) +
                                         " triangles, the limit; simplify its meshes");
        }
    }

    template <int N>
    std::vector<glm::vec<N, float>> read_attribute(const tinygltf::Primitive& primitive, const char* attribute,
                                                   std::uint64_t vertex_count, const std::string& object) {
        const auto found = primitive.attributes.find(attribute);
        if (found == primitive.attributes.end()) {
            return {};
        }
        if (accessors_.count(found->second) != vertex_count) {
            document_.refuse(object, std::string(attribute) +
                                         " has another length than POSITION; each vertex needs one value");
        }
        return accessors_.read_vectors<N>(found->second, object + ": " + attribute);
    }

    std::vector<glm::vec2> read_coordinates(const tinygltf::Primitive& primitive, const char* attribute,
                                            std::uint64_t vertex_count, const std::string& object) {
        std::vector<glm::vec2> coordinates = read_attribute<2>(primitive, attribute, vertex_count, object);
        for (glm::vec2& uv : coordinates) {
            uv = glm::clamp(uv, static_cast<float>(kTextureRange.low), static_cast<float>(kTextureRange.high));
        }
        return coordinates;
    }

    std::vector<glm::vec4> read_colours(const tinygltf::Primitive& primitive, std::uint64_t vertex_count,
                                        const std::string& object) {
        const auto found = primitive.attributes.find("COLOR_0");
        if (found == primitive.attributes.end()) {
            return {};
        }
        std::vector<glm::vec4> colours;
        if (accessors_.components(found->second) == 3) {
            const auto opaque = read_attribute<3>(primitive, "COLOR_0", vertex_count, object);
            std::transform(opaque.begin(), opaque.end(), std::back_inserter(colours),
                           [](const glm::vec3& colour) { return glm::vec4(colour, 1.0F); });
        } else {
            colours = read_attribute<4>(primitive, "COLOR_0", vertex_count, object);
        }
        for (glm::vec4& colour : colours) {
            colour = glm::clamp(colour, 0.0F, 1.0F);
        }
        return colours;
    }

    std::vector<std::uint32_t> read_corners(const tinygltf::Primitive& primitive, std::uint64_t vertex_count,
                                            const std::string& object) {
        if (primitive.indices >= 0) {
            return accessors_.read_indices(primitive.indices, object + ": indices");
        }
        std::vector<std::uint32_t> corners(vertex_count);
        std::iota(corners.begin(), corners.end(), 0U);
        return corners;
    }

    std::vector<glm::uvec3> triangles_of(int mode, const std::vector<std::uint32_t>& corners,
                                         std::uint64_t vertex_count, const std::string& object) const {
        const auto bad =
            std::find_if(corners.begin(), corners.end(), [&](std::uint32_t corner) { return corner >= vertex_count; });
        if (bad != corners.end()) {
            document_.refuse(object, "index " + std::to_string(*bad) + " is beyond its " +
                                         std::to_string(vertex_count) + " vertices");
        }
        const bool is_list = mode == TINYGLTF_MODE_TRIANGLES;
        if (corners.size() < 3 || (is_list && corners.size() % 3 != 0)) {
            document_.refuse(object, std::to_string(corners.size()) + " corners do not form triangles; a list needs a "
                                                                      "multiple of 3, a strip or fan at least 3");
        }
        std::vector<glm::uvec3> triangles(is_list ? corners.size() / 3 : corners.size() - 2);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            if (is_list) {
                triangles[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
            } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) { // every other triangle has the opposite winding
                triangles[i] = {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
            } else {
                triangles[i] = {corners[i + 1], corners[i + 2], corners[0]};
            }
        }
        return triangles;
    }

    GltfDocument& document_;
    GltfBufferViews& views_;
    GltfAccessors& accessors_;
    const SceneLimits limits_;
    GltfMeshes result_;
    std::map<int, MeshRange> ranges_; // per glTF mesh
    std::uint64_t triangle_count_ = 0;
    std::uint64_t vertex_count_ = 0;
};

} // namespace

GltfMeshes read_meshes(GltfDocument& document, GltfBufferViews& views, GltfAccessors& accessors, const GltfNodes& nodes,
                       const SceneLimits& limits) {
    return MeshReader(document, views, accessors, limits).read(nodes);
}

} // namespace fieldcast::scene
