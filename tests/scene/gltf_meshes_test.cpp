// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/gltf_builder.h"

#include <gmock/gmock.h>
#include <meshoptimizer.h>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;

const std::vector<float> kQuad{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// Loads one primitive over the corners of the unit square.
Mesh load_quad(int mode, const std::vector<std::uint8_t>& indices) {
    GltfBuilder builder;
    nlohmann::json primitive{{"attributes",
                              {{"POSITION", builder.add_floats(kQuad, "VEC3")},
                               {"NORMAL", builder.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}},
                             {"mode", mode}};
    if (!indices.empty()) {
        primitive["indices"] = builder.add_accessor(indices, "SCALAR", kU8);
    }
    builder.add_node({{"mesh", builder.add_mesh(primitive)}});
    return builder.load().meshes.at(0);
}

TEST(GltfMeshes, ReadsIndexedTriangles) {
    const Mesh mesh = load_quad(kTriangles, {0, 1, 2, 0, 2, 3});
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 2, 3));
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
}

TEST(GltfMeshes, TurnsStripsIntoTrianglesOfEqualOrientation) {
    const Mesh mesh = load_quad(kStrip, {0, 1, 3, 2});
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 1, 3));
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(1, 2, 3)); // the winding is still counter-clockwise
}

TEST(GltfMeshes, TurnsFansIntoTriangles) {
    const Mesh mesh = load_quad(kFan, {});
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.triangles[0], glm::uvec3(1, 2, 0));
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(2, 3, 0));
}

TEST(GltfMeshes, ReadsTrianglesWithoutIndices) {
    GltfBuilder builder;
    builder.add_triangle();
    const Scene scene = builder.load();
    ASSERT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.meshes[0].triangles, std::vector{glm::uvec3(0, 1, 2)});
    EXPECT_EQ(scene.materials.at(scene.meshes[0].material).name, "default");
}

TEST(GltfMeshes, MakesFlatNormalsAndKeepsDegenerateTriangles) {
    GltfBuilder builder;
    const int position = builder.add_floats({0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0}, "VEC3");
    const int indices = builder.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 3, 0}, "SCALAR", kU16);
    const int uv = builder.add_floats({0, 0, 1, 0, 0, 1, 0, 0}, "VEC2");
    builder.add_node({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", position}, {"TEXCOORD_1", uv}}},
                                                 {"indices", indices}})}});
    const Mesh mesh = builder.load().meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 6U);
    ASSERT_EQ(mesh.normals.size(), 6U);
    ASSERT_EQ(mesh.uv1.size(), 6U);
    EXPECT_TRUE(mesh.uv0.empty());
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.uv1[2], glm::vec2(0, 1));
    EXPECT_FLOAT_EQ(glm::length(mesh.normals[5]), 1.0F);
}

TEST(GltfMeshes, RepairsNormalsAndTangentsWithoutDirection) {
    GltfBuilder builder;
    builder.add_triangle();
    const int normal = builder.add_floats({0, 0, 0, 0, 0, 7, 0, 0, 1}, "VEC3");
    const int tangent = builder.add_floats({0, 0, 0, 1, 2, 0, 0, -1, 1, 0, 0, 0}, "VEC4");
    builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normal;
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = tangent;
    const Mesh mesh = builder.load().meshes.at(0);
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1)); // normal of the triangle
    EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 1));
    EXPECT_FLOAT_EQ(glm::length(glm::vec3(mesh.tangents[0])), 1.0F);
    EXPECT_EQ(mesh.tangents[1], glm::vec4(1, 0, 0, -1));
    EXPECT_EQ(mesh.tangents[2].w, 1.0F);
}

TEST(GltfMeshes, ReadsColoursOfThreeAndFourComponents) {
    GltfBuilder builder;
    builder.add_triangle();
    auto& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["COLOR_0"] =
        builder.add_accessor(std::vector<std::uint16_t>{65535, 0, 0, 0, 0, 65535, 0, 0, 0}, "VEC3", kU16, true);
    // Exporters pad rows of three 16-bit values; here they are packed.
    const Mesh rgb = builder.load().meshes.at(0);
    EXPECT_EQ(rgb.colours.at(0), glm::vec4(1, 0, 0, 1));
    attributes["COLOR_0"] = builder.add_floats({1, 0, 0, 0.5F, 2, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
    const Mesh rgba = builder.load().meshes.at(0);
    EXPECT_EQ(rgba.colours.at(0), glm::vec4(1, 0, 0, 0.5F));
    EXPECT_EQ(rgba.colours.at(1), glm::vec4(1, 0, 0, 1)); // clamped to 0 … 1
}

TEST(GltfMeshes, ReadsQuantisedAttributes) {
    GltfBuilder builder;
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int position = builder.add_accessor(std::vector<std::int16_t>{-100, 0, 0, 300, 0, 0, 0, 7, 0}, "VEC3", kI16);
    const int normal =
        builder.add_accessor(std::vector<std::int8_t>{0, 0, 127, 0, 0, -128, 0, 127, 0}, "VEC3", kI8, true);
    const int uv = builder.add_accessor(std::vector<std::uint8_t>{0, 255, 51, 0, 1, 2}, "VEC2", kU8, true);
    builder.add_node(
        {{"mesh",
          builder.add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}}})}});
    const Mesh mesh = builder.load().meshes.at(0);
    EXPECT_EQ(mesh.positions[1], glm::vec3(300, 0, 0));
    EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, -1));
    EXPECT_FLOAT_EQ(mesh.uv0[1].x, 0.2F);
}

TEST(GltfMeshes, ReadsInterleavedViews) {
    GltfBuilder builder;
    const std::vector<float> rows{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
    const int view = builder.add_view(std::as_bytes(std::span(rows)), 24);
    const auto accessor = [&](int offset) {
        return builder.add(
            "accessors",
            {{"bufferView", view}, {"byteOffset", offset}, {"componentType", kF32}, {"count", 3}, {"type", "VEC3"}});
    };
    const int position = accessor(0);
    const int normal = accessor(12);
    builder.add_node({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}})}});
    const Mesh mesh = builder.load().meshes.at(0);
    EXPECT_EQ(mesh.positions[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
}

TEST(GltfMeshes, AppliesSparseAccessors) {
    GltfBuilder builder;
    builder.add_triangle();
    const std::vector<std::uint8_t> at{1, 2};
    const std::vector<float> values{5, 6, 7, 8, 9, 10};
    builder.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", builder.add_view(std::as_bytes(std::span(at)))}, {"componentType", kU8}}},
        {"values", {{"bufferView", builder.add_view(std::as_bytes(std::span(values)))}}}};
    const Mesh mesh = builder.load().meshes.at(0);
    EXPECT_EQ(mesh.positions[0], glm::vec3(0, 0, 0));
    EXPECT_EQ(mesh.positions[1], glm::vec3(5, 6, 7));
    EXPECT_EQ(mesh.positions[2], glm::vec3(8, 9, 10));
    builder.json["accessors"][0].erase("bufferView"); // without a view: zeros, replaced by the sparse values
    EXPECT_EQ(builder.load().meshes.at(0).positions[1], glm::vec3(5, 6, 7));
}

TEST(GltfMeshes, SharesMeshesBetweenNodes) {
    GltfBuilder builder;
    const int mesh = builder.add_triangle();
    builder.json["meshes"][0]["primitives"].push_back(builder.json["meshes"][0]["primitives"][0]);
    builder.add_node({{"mesh", mesh}, {"scale", {-1, 2, 3}}}); // mirrored and not uniform, which glTF allows
    const Scene scene = builder.load();
    EXPECT_EQ(scene.meshes.size(), 2U);
    ASSERT_EQ(scene.instances.size(), 4U);
    EXPECT_EQ(scene.instances[2].node, 1U);
    EXPECT_EQ(scene.instances[2].mesh, 0U);
    EXPECT_EQ(scene.instances[3].mesh, 1U);
}

TEST(GltfMeshes, WarnsOncePerKindOfWhatItIgnores) {
    GltfBuilder builder;
    const int mesh = builder.add_triangle();
    auto& primitives = builder.json["meshes"][0]["primitives"];
    primitives[0]["targets"] = nlohmann::json::array({{{"POSITION", 0}}});
    primitives.push_back(primitives[0]);
    primitives[1]["mode"] = kPoints;
    builder.json["skins"].push_back({{"joints", {0}}});
    builder.json["extensionsUsed"] = {"KHR_materials_clearcoat"};
    for (int i = 0; i < 3; ++i) {
        builder.add_node({{"mesh", mesh}, {"skin", 0}});
    }
    EXPECT_THAT(builder.load().warnings,
                testing::ElementsAre("extension KHR_materials_clearcoat is ignored",
                                     "morph targets are ignored (1 primitive)",
                                     "points and lines are ignored (1 primitive)", "skins are ignored (3 nodes)"));
}

/// Compresses buffer views with EXT_meshopt_compression. The views refer to a fallback buffer without data.
struct CompressedBuilder : GltfBuilder {
    CompressedBuilder() {
        json["extensionsUsed"] = json["extensionsRequired"] = {"EXT_meshopt_compression"};
        json["buffers"] = nlohmann::json::array(
            {nullptr, {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    }

    int add_compressed(std::span<const unsigned char> bytes, std::size_t count, std::size_t stride, const char* mode,
                       const char* filter = "NONE") {
        const int view = add_view(std::as_bytes(bytes));
        auto& entry = json["bufferViews"][static_cast<std::size_t>(view)];
        entry["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                          {"byteOffset", entry["byteOffset"]},
                                                          {"byteLength", bytes.size()},
                                                          {"byteStride", stride},
                                                          {"count", count},
                                                          {"mode", mode},
                                                          {"filter", filter}};
        entry["buffer"] = 1;
        entry["byteOffset"] = 0;
        entry["byteLength"] = count * stride;
        if (std::string(mode) == "ATTRIBUTES") {
            entry["byteStride"] = stride;
        }
        json["buffers"][0] = {{"byteLength", binary.size()},
                              {"uri", "data:application/octet-stream;base64," + base64(binary)}};
        return view;
    }

    template <class T> int add_vertices(const std::vector<T>& values, std::size_t stride, const char* filter = "NONE") {
        const std::size_t count = values.size() * sizeof(T) / stride;
        std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
        bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), count, stride));
        return add_compressed(bytes, count, stride, "ATTRIBUTES", filter);
    }

    int add_view_accessor(int view, std::size_t count, const char* type, int component_type) {
        return add("accessors",
                   {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
    }
};

TEST(GltfMeshes, DecodesMeshoptVerticesTrianglesAndSequences) {
    for (const std::string mode : {"TRIANGLES", "INDICES"}) {
        CompressedBuilder builder;
        const std::vector<unsigned> indices{0, 1, 2, 0, 2, 3};
        std::vector<unsigned char> bytes(512);
        bytes.resize(mode == "TRIANGLES" ? meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), 6)
                                         : meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), 6));
        const int position = builder.add_view_accessor(builder.add_vertices(kQuad, 12), 4, "VEC3", kF32);
        const int index =
            builder.add_view_accessor(builder.add_compressed(bytes, 6, 2, mode.c_str()), 6, "SCALAR", kU16);
        builder.add_node({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", index}})}});
        const Mesh mesh = builder.load().meshes.at(0);
        ASSERT_EQ(mesh.triangles.size(), 2U) << mode;
        EXPECT_EQ(mesh.positions[4], glm::vec3(1, 1, 0)) << mode; // flat normals: corner 1 of triangle 1
    }
}

TEST(GltfMeshes, DecodesMeshoptFilters) {
    CompressedBuilder builder;
    const int position = builder.add_view_accessor(builder.add_vertices(kQuad, 12), 4, "VEC3", kF32);
    // One octahedral normal per vertex, with 8 bits each for x, y, one, w. (127, 0) is +X.
    const std::vector<std::int8_t> octahedral{127, 0, 127, 0, 127, 0, 127, 0, 0, 127, 127, 0, 0, 0, 127, 0};
    const int normal_view = builder.add_vertices(octahedral, 4, "OCTAHEDRAL");
    const int normal = builder.add_view_accessor(normal_view, 4, "VEC3", kI8);
    builder.json["accessors"][static_cast<std::size_t>(normal)]["normalized"] = true;
    // The exponent is in the top 8 bits, the mantissa below: 2^-1 · 3 = 1.5.
    const std::vector<std::uint32_t> exponential(8, 0xFF000003U);
    const int uv = builder.add_view_accessor(builder.add_vertices(exponential, 8, "EXPONENTIAL"), 4, "VEC2", kF32);
    const int indices = builder.add_accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, "SCALAR", kU8);
    builder.json["buffers"][0] = {{"byteLength", builder.binary.size()},
                                  {"uri", "data:;base64," + base64(builder.binary)}};
    builder.add_node(
        {{"mesh", builder.add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                                    {"indices", indices}})}});
    const Mesh mesh = builder.load().meshes.at(0);
    EXPECT_NEAR(mesh.normals[0].x, 1.0F, 1e-3F);
    EXPECT_NEAR(mesh.normals[2].y, 1.0F, 1e-3F);
    EXPECT_NEAR(mesh.normals[3].z, 1.0F, 1e-3F);
    EXPECT_EQ(mesh.uv0[3], glm::vec2(1.5F));
}

TEST(GltfMeshes, RefusesBrokenMeshoptData) {
    CompressedBuilder builder;
    const int view = builder.add_vertices(kQuad, 12);
    const int position = builder.add_view_accessor(view, 4, "VEC3", kF32);
    builder.add_node({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", position}}}, {"mode", kStrip}})}});
    EXPECT_NO_THROW(builder.load());
    const auto refused_with = [&](const char* member, const nlohmann::json& value) {
        CompressedBuilder changed = builder;
        changed.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][member] = value;
        return refusal(changed);
    };
    EXPECT_THAT(refused_with("mode", "ZIP"), HasSubstr("bufferView 0: unknown compression mode"));
    EXPECT_THAT(refused_with("filter", "OCTAHEDRAL"), HasSubstr("does not fit"));
    EXPECT_THAT(refused_with("count", 1000000000), HasSubstr("is not its byteLength"));
    EXPECT_THAT(refused_with("byteLength", 1 << 30), HasSubstr("outside its buffer"));
    EXPECT_THAT(refused_with("byteOffset", 8), HasSubstr("outside its buffer"));
    EXPECT_THAT(refused_with("buffer", 1), HasSubstr("outside its buffer"));
    EXPECT_THAT(refused_with("buffer", 9), HasSubstr("has no buffer"));
    EXPECT_THAT(refused_with("byteOffset", 1LL << 40), HasSubstr("is not an integer"));
    EXPECT_THAT(refused_with("byteLength", 9), HasSubstr("compressed data is broken"));
    CompressedBuilder huge = builder; // claims 10⁹ bytes from about a hundred
    huge.json["buffers"][1]["byteLength"] = 1LL << 40;
    huge.json["bufferViews"][0]["byteLength"] = 1200000000;
    huge.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 100000000;
    EXPECT_THAT(refusal(huge), HasSubstr("cannot hold 100000000 elements"));
}

TEST(GltfMeshes, CountsTrianglesBeforeItAllocates) {
    GltfBuilder builder;
    const int mesh = builder.add_triangle();
    auto& primitives = builder.json["meshes"][0]["primitives"];
    for (int i = 0; i < 9; ++i) {
        primitives.push_back(primitives[0]);
    }
    LoadOptions options;
    options.limits.max_triangles = 10;
    EXPECT_EQ(builder.load(options).instances.size(), 10U);
    builder.add_node({{"mesh", mesh}}); // instances do not count
    EXPECT_EQ(builder.load(options).instances.size(), 20U);
    options.limits.max_triangles = 9;
    EXPECT_THAT(refusal(builder, options), HasSubstr("primitive 9: brings the scene to more than 9 triangles"));
}

} // namespace
} // namespace fieldcast::scene
