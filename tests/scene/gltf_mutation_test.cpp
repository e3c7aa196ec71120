// SPDX-License-Identifier: Apache-2.0
// Truncated and damaged files must be refused with UserError or load. The sanitizer builds run these tests, too.
#include "core/base/error.h"
#include "tests/scene/gltf_builder.h"

#include <gmock/gmock.h>
#include <random>

namespace fieldcast::scene {
namespace {

constexpr unsigned kSeed = 20240611;
constexpr int kRounds = 1500;

/// A file that exercises most of the loader.
GltfBuilder rich_scene() {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
    builder.add(
        "materials",
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {1, 0.5, 0.25, 1}},
           {"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {1, 2}}}}}}}}}},
         {"alphaMode", "MASK"}});
    builder.add_texture();
    auto& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["indices"] = builder.add_accessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", kU16);
    const std::vector<std::uint8_t> at{2};
    const std::vector<float> value{0, 2, 0};
    builder.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", builder.add_view(std::as_bytes(std::span(at)))}, {"componentType", kU8}}},
        {"values", {{"bufferView", builder.add_view(std::as_bytes(std::span(value)))}}}};
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    builder.add_node({{"camera", 0}, {"children", {2}}, {"rotation", {0, 0, 0, 1}}});
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const int times = builder.add_floats({0, 1}, "SCALAR");
    const int turns = builder.add_floats({0, 0, 0, 1, 0, 1, 0, 0}, "VEC4");
    builder.add("animations", {{"samplers", {{{"input", times}, {"output", turns}}}},
                               {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}});
    return builder;
}

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

class MutationTest : public testing::TestWithParam<const char*> {
protected:
    MutationTest() : original_(std::string(GetParam()) == "glb" ? rich_scene().glb() : bytes_of(rich_scene().gltf())) {
        options_.limits = {1 << 16, 1 << 16, 1 << 18, 1 << 24};
    }

    /// Whether the bytes load. Any exception but UserError propagates and fails the test.
    bool loads(std::span<const std::byte> bytes) {
        try {
            const Scene scene = load_scene(folder_.write("mutant", bytes), options_);
            pose_scene(scene, 123456789);
            return true;
        } catch (const UserError&) {
            return false;
        }
    }

    TempFolder folder_;
    LoadOptions options_;
    std::vector<std::byte> original_;
};

TEST_P(MutationTest, OriginalLoads) {
    EXPECT_TRUE(loads(original_));
}

TEST_P(MutationTest, SurvivesTruncationAtEveryLength) {
    for (std::size_t size = 0; size < original_.size(); ++size) {
        loads(std::span(original_).first(size));
    }
}

TEST_P(MutationTest, SurvivesChangedBytes) {
    std::mt19937 random(kSeed);
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::byte> mutant = original_;
        const std::size_t changes = 1 + random() % 4;
        for (std::size_t i = 0; i < changes; ++i) {
            mutant[random() % mutant.size()] = static_cast<std::byte>(random());
        }
        loads(mutant);
    }
}

/// Replaces digits by digits, so that the JSON remains valid with wrong numbers.
TEST_P(MutationTest, SurvivesChangedNumbers) {
    std::mt19937 random(kSeed);
    std::vector<std::size_t> digits;
    for (std::size_t i = 0; i < original_.size(); ++i) {
        if (original_[i] >= std::byte{'0'} && original_[i] <= std::byte{'9'}) {
            digits.push_back(i);
        }
    }
    int loaded = 0;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::byte> mutant = original_;
        const std::size_t changes = 1 + random() % 3;
        for (std::size_t i = 0; i < changes; ++i) {
            mutant[digits[random() % digits.size()]] = static_cast<std::byte>('0' + random() % 10);
        }
        loaded += loads(mutant) ? 1 : 0;
    }
    EXPECT_GT(loaded, 0); // otherwise all mutants are refused too early to test the loader
}

/// Replaces one JSON value by a typical value of hostile files.
TEST_P(MutationTest, SurvivesReplacedValues) {
    const std::vector<nlohmann::json> hostile{-1,
                                              0,
                                              1,
                                              7,
                                              2147483647,
                                              4294967296,
                                              9007199254740993,
                                              1e300,
                                              0.5,
                                              "",
                                              nullptr,
                                              true,
                                              nlohmann::json::array(),
                                              nlohmann::json::object(),
                                              {0, 0, 0}};
    const GltfBuilder builder = rich_scene();
    const nlohmann::json flat = builder.json.flatten();
    std::mt19937 random(kSeed);
    for (const auto& [pointer, old] : flat.items()) {
        for (int round = 0; round < 6; ++round) {
            GltfBuilder mutant = builder;
            mutant.json[nlohmann::json::json_pointer(pointer)] = hostile[random() % hostile.size()];
            const bool is_glb = std::string(GetParam()) == "glb";
            loads(is_glb ? mutant.glb() : bytes_of(mutant.gltf()));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Containers, MutationTest, testing::Values("glb", "gltf"),
                         [](const auto& test) { return std::string(test.param); });

} // namespace
} // namespace fieldcast::scene
