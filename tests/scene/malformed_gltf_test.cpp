// SPDX-License-Identifier: Apache-2.0
// Messages with which load_scene refuses the files in tests/data/malformed_gltf (written by generate.py there).
#include "tests/scene/gltf_builder.h"

#include <fstream>
#include <gmock/gmock.h>
#include <map>

namespace fieldcast::scene {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

const fs::path kFolder = "tests/data/malformed_gltf";

/// File, and the text after its name at the beginning of the message.
const std::map<std::string, std::string> kExpected{
    {"accessor_beyond_view.gltf", "accessor 0: ends 12 bytes beyond bufferView 0"},
    {"accessor_count_fraction.gltf", "accessors/0/count: is not an integer"},
    {"accessor_count_negative.gltf", "accessors/0/count: is not an integer"},
    {"accessor_count_overflow.gltf", "accessors/0/count: is not an integer"},
    {"accessor_count_zero.gltf", "accessor 0: has no elements"},
    {"accessor_double.gltf", "accessor 0: unknown componentType 5130"},
    {"accessor_huge_count.gltf", "accessor 0: ends 11999999964 bytes beyond bufferView 0"},
    {"accessor_huge_without_view.gltf", "mesh 0: primitive 0: brings the scene to more than 67108864 triangles"},
    {"accessor_offset_beyond_view.gltf", "accessor 0: ends 1000 bytes beyond bufferView 0"},
    {"accessor_type.gltf", "json: "},
    {"accessor_wrong_shape.gltf", "mesh 0: primitive 0: POSITION: accessor 0: has the wrong type"},
    {"buffer_missing.gltf", "bufferView 0: buffer 1 does not exist"},
    {"buffer_too_short.gltf", "buffer 0: claims 81 bytes but has 80"},
    {"cycle_of_one.gltf", "node 0 'triangle': is its own ancestor"},
    {"cycle_of_two.gltf", "node 1: is its own ancestor"},
    {"depth_bomb.gltf", "json: is nested deeper"},
    {"empty.gltf", "json: "},
    {"empty_scene.gltf", "scene: shows no triangles"},
    {"glb_chunk_beyond_file.glb", "glb chunk: claims 4294967280 bytes"},
    {"glb_header_only.glb", "glb header: file is truncated"},
    {"glb_length_beyond_file.glb", "glb header: claims 2147483648 bytes"},
    {"glb_short_binary.glb", "buffer 0: claims 80 bytes but has 40"},
    {"glb_version_1.glb", "glb header: only version 2"},
    {"glb_without_json.glb", "glb chunk: the first chunk is not JSON"},
    {"image_huge.gltf", "image 0: "},
    {"image_missing.gltf", "image 0 'none.png': cannot open 'none.png'"},
    {"image_missing_view.gltf", "image 0: bufferView 12 does not exist"},
    {"image_no_image.gltf", "image 0: "},
    {"image_parent.gltf", "image 0 '../secret.png': path leaves the scene's folder"},
    {"image_truncated.gltf", "image 0: "},
    {"image_without_source.gltf", "image 0 'nothing': needs exactly one of a URI and a buffer view"},
    {"index_beyond_vertices.gltf", "mesh 0: primitive 0: NORMAL has another length"},
    {"index_value.gltf", "mesh 0: primitive 0: index 3 is beyond its 3 vertices"},
    {"indices_of_floats.gltf", "mesh 0: primitive 0: indices: accessor 0: is not a list of indices"},
    {"infinite_normal.gltf", "mesh 0: primitive 0: NORMAL: accessor 1: element 0 is not a finite number"},
    {"material_missing.gltf", "mesh 0: primitive 0: material 0 does not exist"},
    {"mesh_is_text.gltf", "nodes/0/mesh: is not an integer"},
    {"mesh_missing.gltf", "node 0 'triangle': mesh 7 does not exist"},
    {"nan_literal.gltf", "json: "},
    {"nan_position.gltf", "mesh 0: primitive 0: POSITION: accessor 0: element 1 is not a finite number"},
    {"no_asset.gltf", "asset: has no version"},
    {"nodes_are_numbers.gltf", "nodes: is not a list of objects"},
    {"not_json.gltf", "json: line 1, column 1: this is not JSON; a scene must be a glTF 2.0 file"},
    {"not_utf8.gltf", "json: "},
    {"number_too_large.gltf", "json: holds a number beyond the range of double precision"},
    {"primitive_mode.gltf", "mesh 0: primitive 0: unknown mode 9"},
    {"primitive_two_corners.gltf", "mesh 0: primitive 0: 2 corners do not form triangles"},
    {"primitive_without_attributes.gltf", "json: 'attributes' property is missing"},
    {"primitive_without_position.gltf", "mesh 0: primitive 0: has no POSITION"},
    {"required_gpu_instancing.gltf", "extensionsRequired: extension 'EXT_mesh_gpu_instancing' is not supported"},
    {"required_extension.gltf", "extensionsRequired: extension 'VENDOR_unheard_of' is not supported"},
    {"root_is_a_list.gltf", "json: the root is not an object"},
    {"scene_missing.gltf", "json: scene 2 does not exist"},
    {"scene_node_missing.gltf", "scene 0: node 5 does not exist"},
    {"sparse_float_indices.gltf", "accessor 0: sparse indices have componentType 5126"},
    {"sparse_huge.gltf", "accessor 0: sparse count 2000000000 is out of range"},
    {"sparse_missing_view.gltf", "accessor 0 (sparse values): bufferView 9 does not exist"},
    {"sparse_offset.gltf", "accessor 0 (sparse values): ends 6 bytes beyond bufferView 1"},
    {"sparse_unsorted.gltf", "mesh 0: primitive 0: POSITION: accessor 0: sparse indices are out of range or not"},
    {"uri_absent.gltf", "buffer 0: has neither a URI nor a binary chunk"},
    {"uri_absolute.gltf", "buffer 0: absolute path"},
    {"uri_broken_data.gltf", "buffer 0: "},
    {"uri_encoded_parent.gltf", "buffer 0: path leaves the scene's folder"},
    {"uri_folder.gltf", "buffer 0: path names no file"},
    {"uri_missing_file.gltf", "buffer 0: cannot open 'none.bin'"},
    {"uri_parent.gltf", "buffer 0: path leaves the scene's folder"},
    {"uri_scheme.gltf", "buffer 0: URI with a scheme"},
    {"version_1.gltf", "asset: version 1.0 is not supported"},
    {"version_3_needed.gltf", "asset: needs a newer version"},
    {"view_beyond_buffer.gltf", "bufferView 0: ends at byte 81 of a buffer of 80 bytes"},
    {"view_index_truncated.gltf", "accessors/0/bufferView: is not an integer"},
    {"view_missing.gltf", "accessor 0: bufferView 3 does not exist"},
    {"view_offset_overflow.gltf", "bufferViews/0/byteOffset: is not an integer"},
    {"view_stride_odd.gltf", "json: "},
    {"view_stride_too_small.gltf", "accessor 0: elements are larger than the stride"},
};

TEST(MalformedGltf, EachFileIsRefusedWithPlaceAndReason) {
    for (const auto& [name, message] : kExpected) {
        const std::string said = refusal(kFolder / name);
        EXPECT_THAT(said, StartsWith(name + ": " + message)) << name;
        EXPECT_GT(said.size(), name.size() + message.size()) << name;
    }
}

TEST(MalformedGltf, EveryFileOfTheFolderIsTested) {
    for (const auto& entry : fs::directory_iterator(kFolder)) {
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(name == "generate.py" || kExpected.contains(name)) << name;
    }
}

TEST(MalformedGltf, RefusesWhatIsNoFile) {
    const TempFolder folder;
    EXPECT_THAT(refusal(folder.path() / "none.gltf"), HasSubstr("cannot open"));
    EXPECT_THAT(refusal(folder.path() / "none" / "none.gltf"), HasSubstr("cannot open"));
    EXPECT_THAT(refusal(folder.path()), HasSubstr("cannot open"));
    EXPECT_THAT(refusal("/dev/zero"), HasSubstr("not a regular file"));
}

TEST(MalformedGltf, RefusesLinksThatLeaveTheFolder) {
    const TempFolder outside;
    const TempFolder folder;
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "link.bin"}}};
    outside.write("data.bin", builder.binary);
    fs::create_symlink(outside.path() / "data.bin", folder.path() / "link.bin");
    const fs::path file = folder.write("test.gltf", builder.gltf());
    EXPECT_THAT(refusal(file), HasSubstr("test.gltf: buffer 0: 'link.bin' leaves the scene's folder"));
    fs::remove(folder.path() / "link.bin");
    folder.write("data.bin", builder.binary);
    fs::create_symlink(folder.path() / "data.bin", folder.path() / "link.bin"); // a link within the folder is allowed
    EXPECT_NO_THROW(load_scene(file));
}

TEST(MalformedGltf, RefusesFilesOverTheSizeLimit) {
    GltfBuilder builder;
    builder.add_triangle();
    LoadOptions options;
    options.limits.max_file_bytes = 100;
    EXPECT_THAT(refusal(builder, options), HasSubstr("exceeds the limit on the size of all files"));
}

} // namespace
} // namespace fieldcast::scene
