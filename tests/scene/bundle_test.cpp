// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bundle.h"

#include "core/image/image_file.h"
#include "tests/scene/gltf_builder.h"

#include <fstream>
#include <gmock/gmock.h>
#include <random>

namespace fieldcast::scene {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A scene with a buffer, an image and an environment in files, next to files that it does not use.
class BundleTest : public testing::Test {
protected:
    BundleTest() : main_(write_scene(folder_)) {
        image::write_exr(folder_.path() / "outside.exr", image::RgbF32{2, 1, {glm::vec3(1.0F), glm::vec3(2.0F)}});
        with_sky_.environment = folder_.path() / "outside.exr";
    }

    static fs::path write_scene(const TempFolder& folder) {
        GltfBuilder builder;
        builder.add_triangle();
        builder.add("materials", {{"normalTexture", {{"index", 0}}}});
        builder.add("textures", {{"source", 0}});
        builder.add("images", {{"uri", "maps/n.png"}});
        builder.json["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "data.bin"}}};
        folder.write("in/data.bin", builder.binary);
        folder.write("in/maps/n.png", small_png(2, 2));
        folder.write("in/unused.txt", std::string("secret"));
        return folder.write("in/scene.gltf", builder.gltf());
    }

    TempFolder folder_;
    fs::path main_;
    LoadOptions with_sky_;
};

std::vector<std::string> files_below(const fs::path& folder) {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files.push_back(entry.path().lexically_relative(folder).string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

TEST_F(BundleTest, RoundTripKeepsFilesOptionsAndHash) {
    const Scene scene = load_scene(main_, with_sky_);
    const std::vector<std::byte> bundle = make_bundle(main_, with_sky_);
    EXPECT_EQ(hash_bundle(bundle), scene.hash);
    const fs::path out = folder_.path() / "out";
    const auto unpacked = unpack_bundle(bundle, out);
    ASSERT_TRUE(unpacked) << unpacked.error().message;
    EXPECT_THAT(files_below(out),
                testing::ElementsAre("data.bin", "environment.fieldcast/sky.exr", "maps/n.png", "scene.gltf"));
    const Scene again = load_scene(unpacked->file, unpacked->options);
    EXPECT_EQ(again.hash, scene.hash);
    EXPECT_EQ(again.environment.pixels, scene.environment.pixels);
    EXPECT_EQ(make_bundle(unpacked->file, unpacked->options), bundle);
}

/// The client's studio, decoded from the bundle, equals the computed one bit for bit.
TEST_F(BundleTest, TheStudioTravels) {
    const LoadOptions in_studio{.environment = {}, .surroundings = Surroundings::kStudio, .limits = {}};
    const Scene scene = load_scene(main_, in_studio);
    EXPECT_TRUE(scene.has_studio);
    const std::vector<std::byte> bundle = make_bundle(main_, in_studio);
    EXPECT_EQ(hash_bundle(bundle), scene.hash);
    const auto unpacked = unpack_bundle(bundle, folder_.path() / "out");
    ASSERT_TRUE(unpacked) << unpacked.error().message;
    const Scene again = load_scene(unpacked->file, unpacked->options);
    EXPECT_EQ(again.hash, scene.hash);
    EXPECT_EQ(again.environment.constant, scene.environment.constant);
    EXPECT_EQ(again.environment.width_px, scene.environment.width_px);
    EXPECT_EQ(again.environment.pixels, scene.environment.pixels);
}

TEST_F(BundleTest, HashDependsOnContentNotOnPlace) {
    const TempFolder elsewhere;
    const fs::path copy = write_scene(elsewhere);
    EXPECT_EQ(load_scene(copy).hash, load_scene(main_).hash);
    LoadOptions dusk;
    dusk.sky = {0.1F, 0.1F, 0.1F};
    EXPECT_NE(load_scene(copy, dusk).hash, load_scene(main_).hash);
    EXPECT_NE(load_scene(main_, with_sky_).hash, load_scene(main_).hash);
    LoadOptions other_limits;
    other_limits.limits.max_triangles = 10;
    EXPECT_EQ(load_scene(main_, other_limits).hash, load_scene(main_).hash);
    elsewhere.write("in/maps/n.png", small_png(2, 3));
    EXPECT_NE(load_scene(copy).hash, load_scene(main_).hash);
}

TEST_F(BundleTest, HashIsStableOverReleases) {
    const TempFolder folder;
    const fs::path file = folder.write("tiny.gltf", R"({"asset":{"version":"2.0"}})");
    // Bytes written by hand according to the layout in bundle.cpp.
    std::string expected("FCBUNDLE\x01\0\0\0\0\0\0\x3F\x33\x33\x33\x3F\0\0\x80\x3F\x09\0tiny.gltf\0\0\x01\0\0\0", 41);
    expected += std::string("\x09\0tiny.gltf\x1B\0\0\0\0\0\0\0", 19) + R"({"asset":{"version":"2.0"}})";
    const auto bytes = std::as_bytes(std::span(expected));
    EXPECT_EQ(make_bundle(file, {}), std::vector<std::byte>(bytes.begin(), bytes.end()));
}

TEST(Sha256, MatchesTheStandard) {
    const std::string abc = "abc";
    EXPECT_EQ(to_hex(hash_bundle(std::as_bytes(std::span(abc)))),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"); // FIPS 180-2, B.1
}

TEST_F(BundleTest, EveryTruncationIsRefusedAndWritesNothing) {
    const std::vector<std::byte> bundle = make_bundle(main_, with_sky_);
    const fs::path out = folder_.path() / "out";
    for (std::size_t size = 0; size < bundle.size(); size += size < 400 ? 1 : 37) {
        const auto unpacked = unpack_bundle(std::span(bundle).first(size), out);
        ASSERT_FALSE(unpacked) << size;
        ASSERT_FALSE(fs::exists(out)) << size;
    }
    std::vector<std::byte> longer = bundle;
    longer.push_back(std::byte{0});
    EXPECT_THAT(unpack_bundle(longer, out).error().message, HasSubstr("bytes after the last file"));
}

TEST_F(BundleTest, SurvivesRandomChanges) {
    const std::vector<std::byte> bundle = make_bundle(main_, with_sky_);
    std::mt19937 random(7);
    const fs::path root = folder_.path() / "out";
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::byte> changed = bundle;
        for (int i = 0; i < 4; ++i) {
            changed[random() % std::min<std::size_t>(changed.size(), 300)] = static_cast<std::byte>(random());
        }
        const auto unpacked = unpack_bundle(changed, root / "in");
        if (unpacked) {
            for (const std::string& file : files_below(root)) {
                ASSERT_TRUE(file.starts_with("in/")) << file;
            }
        }
        fs::remove_all(root);
    }
}

/// A bundle of made-up files.
std::vector<std::byte> forged(const std::vector<std::string>& paths, const std::string& main,
                              const std::string& environment = {}) {
    std::string text("FCBUNDLE\x01\0\0\0", 12);
    const auto add_integer = [&](std::uint64_t value, int size) {
        for (int i = 0; i < size; ++i) {
            text += static_cast<char>(value >> (8 * i) & 0xFFU);
        }
    };
    const auto add_path = [&](const std::string& path) {
        add_integer(path.size(), 2);
        text += path;
    };
    text.append(12, '\0');
    add_path(main);
    add_path(environment);
    add_integer(paths.size(), 4);
    for (const std::string& path : paths) {
        add_path(path);
        add_integer(1, 8);
        text += 'x';
    }
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

TEST(UnpackBundle, RefusesForgedPaths) {
    const TempFolder folder;
    const fs::path out = folder.path() / "out";
    const auto refused = [&](const std::vector<std::string>& paths, const std::string& main = "s.gltf",
                             const std::string& environment = {}) {
        const auto unpacked = unpack_bundle(forged(paths, main, environment), out);
        EXPECT_FALSE(fs::exists(out));
        return unpacked ? "(accepted)" : unpacked.error().message;
    };
    EXPECT_THAT(refused({"../evil", "s.gltf"}), HasSubstr("leaves the scene's folder"));
    EXPECT_THAT(refused({"/etc/evil", "s.gltf"}), HasSubstr("absolute"));
    EXPECT_THAT(refused({"a/../../evil", "s.gltf"}), HasSubstr("leaves the scene's folder"));
    EXPECT_THAT(refused({"a/./b", "s.gltf"}), HasSubstr("shortest form"));
    EXPECT_THAT(refused({"a//b", "s.gltf"}), HasSubstr("shortest form"));
    EXPECT_THAT(refused({"a\\b", "s.gltf"}), HasSubstr("backslash"));
    EXPECT_THAT(refused({"file:x", "s.gltf"}), HasSubstr("scheme"));
    EXPECT_THAT(refused({std::string("a\0b", 3), "s.gltf"}), HasSubstr("control character"));
    EXPECT_THAT(refused({"", "s.gltf"}), HasSubstr("not sorted or not unique"));
    EXPECT_THAT(refused({"s.gltf", "s.gltf"}), HasSubstr("not sorted or not unique"));
    EXPECT_THAT(refused({"s.gltf", "a"}), HasSubstr("not sorted or not unique"));
    EXPECT_THAT(refused({"a", "a/b", "s.gltf"}), HasSubstr("also that of a folder"));
    EXPECT_THAT(refused({"a"}), HasSubstr("glTF file is missing"));
    EXPECT_THAT(refused({"d/s.gltf"}, "d/s.gltf"), HasSubstr("topmost folder"));
    EXPECT_THAT(refused({"s.gltf"}, "s.gltf", "environment.fieldcast/sky.hdr"), HasSubstr("environment"));
    EXPECT_THAT(refused({"s.gltf"}, "s.gltf", "s.gltf"), HasSubstr("environment"));
    EXPECT_THAT(refused({std::string(300, 'a'), "s.gltf"}), HasSubstr("too long"));
    EXPECT_TRUE(unpack_bundle(forged({"s.gltf"}, "s.gltf"), out));
}

TEST(UnpackBundle, RefusesFoldersThatAreInUse) {
    const TempFolder folder;
    folder.write("kept.txt", std::string("mine"));
    const auto unpacked = unpack_bundle(forged({"kept.txt", "s.gltf"}, "s.gltf"), folder.path());
    ASSERT_FALSE(unpacked);
    EXPECT_THAT(unpacked.error().message, HasSubstr("not a new or empty folder"));
    EXPECT_EQ(fs::file_size(folder.path() / "kept.txt"), 4U);
    EXPECT_FALSE(unpack_bundle(forged({"s.gltf"}, "s.gltf"), folder.path() / "kept.txt"));
}

} // namespace
} // namespace fieldcast::scene
