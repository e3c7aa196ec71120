// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/foreign_format.h"

#include "core/base/error.h"
#include "core/scene/gltf/loader.h"
#include "tests/fixtures/test_folder.h"

#include <fstream>
#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string format_of(std::string_view text, const std::string& file) {
    return foreign_format(std::as_bytes(std::span(text)), file).value_or("");
}

TEST(ForeignFormat, IsFoundByTheFirstBytesBeforeTheName) {
    EXPECT_THAT(format_of("Kaydara FBX Binary  \0", "hall.gltf"), HasSubstr("this is FBX; convert it to glTF 2.0"));
    EXPECT_THAT(format_of("BLENDER-v300", "hall"), HasSubstr("File > Export > glTF 2.0"));
    EXPECT_THAT(format_of("ply\nformat ascii 1.0\n", "scan.obj"), HasSubstr("this is PLY"));
}

TEST(ForeignFormat, IsFoundByTheNameInAnyCase) {
    EXPECT_THAT(format_of("v 0 0 0\n", "Hall.OBJ"), AllOf(HasSubstr("this is OBJ"), HasSubstr("obj2gltf")));
    EXPECT_THAT(format_of("PK\x03\x04", "hall.usdz"), HasSubstr("this is USDZ"));
    EXPECT_EQ(format_of("v 0 0 0\n", "hall.txt"), "");
    EXPECT_EQ(format_of("", "obj"), "");
}

TEST(ForeignFormat, IsNamedWhenASceneIsRefused) {
    const test::TestFolder folder;
    const auto file = folder / "hall.obj";
    std::ofstream(file) << "# a comment\nv 0 0 0\n";
    try {
        load_scene(file, {});
        FAIL() << "an OBJ file was loaded";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("hall.obj: format: this is OBJ; convert it to glTF 2.0"));
    }
}

} // namespace
} // namespace fieldcast::scene
