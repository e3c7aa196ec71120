// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bundle.h"
#include "tests/scene/draco_builder.h"

#include <algorithm>
#include <array>
#include <draco/compression/encode.h>
#include <gmock/gmock.h>
#include <random>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Number of triangles of `mesh` that differ from each triangle of `corners` by more than the quantisation. Encoders
/// may change the order of triangles and the first corner of each.
std::size_t differing_triangles(const Mesh& mesh, const Corners& corners) {
    const auto is_near = [](auto a, auto b, float tolerance) {
        const auto difference = glm::abs(a - b);
        return glm::all(glm::lessThanEqual(difference, decltype(difference)(tolerance)));
    };
    const auto is_same = [&](std::uint32_t vertex, const Corner& corner) {
        // Steps: 8 m / 2¹⁴ and 2 / 2¹² of texture coordinates and tangents; octahedral normals of 2 / 2¹² per axis.
        return is_near(mesh.positions[vertex], corner.position, 5e-4F) &&
               is_near(mesh.normals[vertex], corner.normal, 2e-3F) && is_near(mesh.uv0[vertex], corner.uv, 5e-4F) &&
               is_near(mesh.colours[vertex], glm::vec4(corner.colour) / 255.0F, 1e-6F) &&
               is_near(mesh.tangents[vertex], corner.tangent, 1e-2F);
    };
    const auto is_in_corners = [&](const glm::uvec3& triangle) {
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            for (std::size_t first = 0; first < 3; ++first) {
                if (is_same(triangle[0], corners[i + first]) && is_same(triangle[1], corners[i + (first + 1) % 3]) &&
                    is_same(triangle[2], corners[i + (first + 2) % 3])) {
                    return true;
                }
            }
        }
        return false;
    };
    return static_cast<std::size_t>(
        std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                      [&](const glm::uvec3& triangle) { return !is_in_corners(triangle); }));
}

constexpr auto kEdgebreaker = draco::MESH_EDGEBREAKER_ENCODING;
constexpr auto kSequential = draco::MESH_SEQUENTIAL_ENCODING;

DracoBuilder sheet_file(draco::MeshEncoderMethod method = kEdgebreaker) {
    return DracoBuilder(draco_encode(*draco_mesh(draco_sheet()), method));
}

TEST(GltfDraco, ReadsAllAttributesOfBothEncodingsWithinTheQuantisation) {
    const Corners corners = draco_sheet();
    const auto mesh = draco_mesh(corners);
    for (const auto method : {kEdgebreaker, kSequential}) {
        for (const int speed : {0, 5, 10}) {
            const DracoData encoded = draco_encode(*mesh, method, speed);
            const Mesh read = DracoBuilder(encoded).load().meshes.at(0);
            const std::string name = "method " + std::to_string(method) + ", speed " + std::to_string(speed);
            ASSERT_EQ(read.triangles.size(), 128U) << name;
            EXPECT_EQ(read.positions.size(), 90U) << name; // 9 × 9, and 9 twice at the seam
            EXPECT_EQ(differing_triangles(read, corners), 0U) << name;
        }
    }
}

TEST(GltfDraco, ConvertsToTheComponentTypesOfAccessors) {
    DracoBuilder builder = sheet_file();
    const Mesh bytes = builder.load().meshes.at(0);
    builder.json["accessors"][3]["componentType"] = kU16; // holds the same integers, so 255 is not 1 any more
    const Mesh shorts = builder.load().meshes.at(0);
    EXPECT_FLOAT_EQ(shorts.colours.at(0).a, 255.0F / 65535.0F);
    EXPECT_FLOAT_EQ(bytes.colours.at(0).a, 1.0F);
    builder.json["accessors"][3]["componentType"] = kI8;
    EXPECT_THAT(refusal(builder), HasSubstr("mesh 0: primitive 0: COLOR_0: compressed value of vertex 0 is missing or "
                                            "does not fit the component type of accessor 3"));
}

TEST(GltfDraco, ReadsUncompressedAttributesBesideCompressedOnes) {
    DracoBuilder builder = sheet_file(kSequential);
    builder.extension()["attributes"].erase("TEXCOORD_0");
    const std::vector<float> coordinates(180, 0.25F);
    builder.primitive()["attributes"]["TEXCOORD_0"] = builder.add_floats(coordinates, "VEC2");
    const Mesh mesh = builder.load().meshes.at(0);
    EXPECT_EQ(mesh.uv0.at(89), glm::vec2(0.25F));
    EXPECT_EQ(mesh.positions.size(), 90U);
}

TEST(GltfDraco, PrefersCompressedDataToItsFallback) {
    DracoBuilder builder = sheet_file();
    builder.json.erase("extensionsRequired");
    const std::vector<float> zeros(270, 0.0F);
    builder.json["accessors"][0]["bufferView"] = builder.add_view(std::as_bytes(std::span(zeros)));
    const Scene scene = builder.load();
    EXPECT_EQ(differing_triangles(scene.meshes.at(0), draco_sheet()), 0U);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfDraco, ReadsStripsAndPrimitivesWithoutIndices) {
    DracoBuilder strip = sheet_file();
    strip.primitive()["mode"] = kStrip; // Draco stores the triangles of a strip, so the count of indices may be any
    strip.json["accessors"][5]["count"] = 150;
    EXPECT_EQ(differing_triangles(strip.load().meshes.at(0), draco_sheet()), 0U);
    EXPECT_EQ(strip.load().meshes.at(0).triangles.size(), 128U);
    DracoBuilder plain = sheet_file();
    plain.primitive().erase("indices");
    EXPECT_EQ(plain.load().meshes.at(0).triangles.size(), 128U);
}

TEST(GltfDraco, EachPrimitiveHasItsOwnData) {
    DracoBuilder builder = sheet_file();
    const DracoData other = draco_encode(*draco_mesh(draco_sheet()), kSequential);
    builder.json["meshes"][0]["primitives"].push_back(builder.primitive());
    builder.json["meshes"][0]["primitives"][1]["extensions"][kDraco]["bufferView"] = builder.add_view(other.bytes);
    const Scene scene = builder.load(); // both primitives use the same accessors
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_EQ(differing_triangles(scene.meshes[0], draco_sheet()), 0U);
    EXPECT_EQ(differing_triangles(scene.meshes[1], draco_sheet()), 0U);
    EXPECT_NE(scene.meshes[0].positions, scene.meshes[1].positions); // the encodings order vertices differently
}

TEST(GltfDraco, ReadsMetadata) {
    const auto mesh = draco_mesh(draco_sheet());
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    metadata->AddEntryString("material", "cloth");
    mesh->AddMetadata(std::move(metadata));
    EXPECT_EQ(DracoBuilder(draco_encode(*mesh, kEdgebreaker)).load().meshes.at(0).triangles.size(), 128U);
}

TEST(GltfDraco, RefusesCountsThatDifferFromTheAccessors) {
    const auto refused_with = [](draco::MeshEncoderMethod method, std::size_t accessor, int count) {
        DracoBuilder builder = sheet_file(method);
        builder.json["accessors"][accessor]["count"] = count;
        return refusal(builder);
    };
    const std::string object = "test.gltf: mesh 0: primitive 0: ";
    for (const auto method : {kEdgebreaker, kSequential}) {
        EXPECT_THAT(refused_with(method, 5, 387),
                    StartsWith(object + "compressed data has 384 indices, but the accessors declare 387"));
        EXPECT_THAT(refused_with(method, 5, 385), StartsWith(object + "385 corners do not form triangles"));
        for (const int count : {89, 91}) {
            EXPECT_THAT(refused_with(method, 0, count),
                        StartsWith(object + "compressed data has 90 vertices, but the accessors declare " +
                                   std::to_string(count)));
        }
        EXPECT_THAT(refused_with(method, 1, 91), StartsWith(object + "NORMAL has another length than POSITION"));
    }
}

TEST(GltfDraco, RefusesAttributesAndAccessorsThatDoNotMatch) {
    const std::string object = "test.gltf: mesh 0: primitive 0: ";
    DracoBuilder builder = sheet_file();
    builder.extension()["attributes"]["NORMAL"] = 99;
    EXPECT_THAT(refusal(builder), StartsWith(object + "NORMAL: compressed data has no attribute with id 99"));
    builder.extension()["attributes"]["NORMAL"] = kFirstId + 2;
    EXPECT_THAT(refusal(builder),
                StartsWith(object + "NORMAL: compressed attribute has 2 components, but its accessor declares 3"));
    builder.extension()["attributes"]["NORMAL"] = -1;
    EXPECT_THAT(refusal(builder), HasSubstr("is not a set of indices"));
    builder = sheet_file();
    builder.primitive()["attributes"].erase("NORMAL");
    EXPECT_THAT(refusal(builder),
                StartsWith(object + "compressed attribute 'NORMAL' is not an attribute of the primitive"));
    builder = sheet_file();
    builder.extension()["bufferView"] = 1;
    EXPECT_THAT(refusal(builder), StartsWith(object + "compressed bufferView 1 does not exist"));
    builder.extension().erase("bufferView");
    EXPECT_THAT(refusal(builder), HasSubstr("KHR_draco_mesh_compression needs a bufferView and attributes"));
    builder.extension() = nlohmann::json::object();
    EXPECT_THAT(refusal(builder), HasSubstr("KHR_draco_mesh_compression needs a bufferView and attributes"));
    builder.extension() = 3;
    EXPECT_THAT(refusal(builder), HasSubstr("extensions/KHR_draco_mesh_compression: is not an object"));
    builder = sheet_file();
    builder.primitive()["mode"] = kFan;
    EXPECT_THAT(refusal(builder), StartsWith(object + "compressed primitive has mode 6; expected 4 or 5"));
    builder = sheet_file();
    builder.json["accessors"][5]["componentType"] = kF32;
    EXPECT_THAT(refusal(builder), StartsWith(object + "indices: accessor 5 cannot hold indices of 90 vertices"));
}

/// Replaces the compressed bytes of a file.
std::string refusal_of_bytes(std::vector<std::byte> bytes) {
    DracoData encoded = draco_encode(*draco_mesh(draco_sheet()), kEdgebreaker);
    encoded.bytes = std::move(bytes);
    return refusal(DracoBuilder(encoded));
}

TEST(GltfDraco, RefusesOtherDataThanMeshesOfVersion22) {
    const std::string object = "test.gltf: mesh 0: primitive 0: ";
    const std::vector<std::byte> mesh = draco_encode(*draco_mesh(draco_sheet()), kEdgebreaker).bytes;
    EXPECT_THAT(refusal_of_bytes({40, std::byte{0xAB}}), StartsWith(object + "has no Draco data"));
    std::vector<std::byte> changed = mesh;
    changed[6] = std::byte{1};
    EXPECT_THAT(refusal_of_bytes(changed), StartsWith(object + "Draco bitstream 2.1 is not supported"));
    changed = mesh;
    changed[8] = std::byte{2};
    EXPECT_THAT(refusal_of_bytes(changed), StartsWith(object + "unknown Draco encoding 2"));

    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodePointCloudToBuffer(*draco_mesh(draco_sheet()), &buffer).ok());
    EXPECT_THAT(refusal_of_bytes(bytes_of(buffer)), StartsWith(object + "Draco data is a point cloud"));
}

/// Sets the varint at `offset` to 2³⁰.
std::vector<std::byte> with_huge_number(std::vector<std::byte> bytes, std::size_t offset) {
    std::size_t end = offset;
    while ((bytes[end] & std::byte{0x80}) != std::byte{0}) {
        ++end;
    }
    const std::array huge{std::byte{0x80}, std::byte{0x80}, std::byte{0x80}, std::byte{0x80}, std::byte{0x04}};
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
    const auto next = bytes.erase(begin, bytes.begin() + static_cast<std::ptrdiff_t>(end + 1));
    bytes.insert(next, huge.begin(), huge.end());
    return bytes;
}

TEST(GltfDraco, ChecksLimitsBeforeItAllocates) {
    const std::string object = "test.gltf: mesh 0: primitive 0: ";
    LoadOptions options;
    options.limits.max_triangles = 128;
    EXPECT_NO_THROW(sheet_file().load(options));
    options.limits.max_triangles = 127;
    EXPECT_THAT(refusal(sheet_file(), options),
                StartsWith(object + "compressed data has 128 triangles, but the limit of the scene leaves 127"));
    // After the header of 11 bytes, sequential data has the number of triangles first. Edgebreaker data has it after
    // the kind of traversal and the number of vertices, which is one byte here.
    for (const auto method : {kEdgebreaker, kSequential}) {
        DracoData encoded = draco_encode(*draco_mesh(draco_sheet()), method);
        encoded.bytes = with_huge_number(encoded.bytes, method == kSequential ? 11 : 13);
        encoded.triangles = 1ULL << 30;
        EXPECT_THAT(refusal(DracoBuilder(encoded)),
                    StartsWith(object + "compressed data has 1073741824 triangles, but the limit of the scene leaves"));
        LoadOptions many;
        many.limits.max_triangles = 1ULL << 40;
        EXPECT_THAT(refusal(DracoBuilder(encoded), many), HasSubstr("bytes cannot hold 1073741824 triangles"));
    }
    LoadOptions small;
    const DracoBuilder sheet_builder = sheet_file();
    small.limits.max_file_bytes = sheet_builder.gltf().size(); // the decoded mesh needs more
    EXPECT_THAT(refusal(sheet_builder, small), StartsWith(object + "decompressed data exceeds the limit on the size"));
}

TEST(GltfDraco, SurvivesTruncatedAndDamagedData) {
    std::mt19937 random(20260101);
    LoadOptions options;
    options.limits = {1 << 16, 1 << 16, 1 << 18, 1 << 24};
    for (const auto method : {kEdgebreaker, kSequential}) {
        const DracoData original = draco_encode(*draco_mesh(draco_sheet()), method, method == kEdgebreaker ? 0 : 5);
        for (std::size_t size = 1; size < original.bytes.size(); size += 7) {
            DracoData cut = original;
            cut.bytes.resize(size);
            EXPECT_THAT(refusal(DracoBuilder(cut), options), StartsWith("test.gltf: mesh 0: primitive 0: ")) << size;
        }
        for (int round = 0; round < 200; ++round) {
            DracoData damaged = original;
            for (std::uint32_t i = 0; i < 1 + random() % 3; ++i) {
                damaged.bytes[5 + random() % (damaged.bytes.size() - 5)] = static_cast<std::byte>(random());
            }
            DracoBuilder builder(damaged);
            if (round % 2 == 1) {
                builder.primitive().erase("indices"); // so that the number of triangles may be any
            }
            refusal(builder, options); // or it loads; anything but UserError fails the test
        }
    }
}

/// Data that claims 2³¹ − 1 orientations of texture coordinates, which takes Draco 10 s.
TEST(GltfDraco, RefusesMoreOrientationsThanCorners) {
    // Speed 0 predicts texture coordinates from positions. The count is a little-endian integer: search it.
    const DracoData original = draco_encode(*draco_mesh(draco_sheet()), kEdgebreaker, 0);
    int refused = 0;
    for (std::size_t at = 20; at + 4 < original.bytes.size(); ++at) {
        if (original.bytes[at + 1] == std::byte{0} && original.bytes[at + 2] == std::byte{0} &&
            original.bytes[at + 3] == std::byte{0}) {
            DracoData changed = original;
            changed.bytes[at + 1] = changed.bytes[at + 2] = std::byte{0xFF};
            changed.bytes[at + 3] = std::byte{0x7F};
            refused += refusal(DracoBuilder(changed)).find("compressed data is broken") != std::string::npos ? 1 : 0;
        }
    }
    EXPECT_GT(refused, 0);
}

TEST(GltfDraco, BundlesKeepCompressedBuffers) {
    const TempFolder folder;
    DracoBuilder builder = sheet_file();
    folder.write("mesh.bin", builder.binary);
    builder.json["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "mesh.bin"}}};
    const auto file = folder.write("draco.gltf", builder.gltf());
    const auto unpacked = unpack_bundle(make_bundle(file, {}), folder.path() / "client");
    ASSERT_TRUE(unpacked);
    const Scene scene = load_scene(unpacked->file, unpacked->options);
    EXPECT_EQ(scene.hash, load_scene(file).hash);
    EXPECT_EQ(differing_triangles(scene.meshes.at(0), draco_sheet()), 0U);
}

} // namespace
} // namespace fieldcast::scene
