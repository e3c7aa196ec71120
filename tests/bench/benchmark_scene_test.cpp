// SPDX-License-Identifier: Apache-2.0
#include "bench/benchmark_scene.h"

#include "core/base/error.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace fieldcast::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(BenchmarkScene, AllOfTheProjectAreWellFormed) {
    EXPECT_THAT(benchmark_scene_names(), ElementsAre("atelier", "breakfast_room", "gas_station", "sponza"));
    for (const std::string& name : benchmark_scene_names()) {
        const BenchmarkScene scene = find_benchmark_scene(name);
        EXPECT_FALSE(scene.title.empty()) << name;
        EXPECT_EQ(scene.file.extension(), ".gltf") << name;
        EXPECT_GT(scene.exposure, 0.0F) << name;
    }
    EXPECT_TRUE(std::filesystem::exists(find_benchmark_scene("atelier").file));
}

TEST(BenchmarkScene, OfAFileHasNoExposure) {
    const BenchmarkScene scene = find_benchmark_scene("scenes/atelier/atelier.gltf");
    EXPECT_EQ(scene.file, "scenes/atelier/atelier.gltf");
    EXPECT_EQ(scene.exposure, 0.0F);
    EXPECT_EQ(find_benchmark_scene("lamp.glb").file, "lamp.glb");
}

TEST(BenchmarkScene, UnknownNamesAreAnsweredWithTheKnownOnes) {
    try {
        find_benchmark_scene("sponsor");
        FAIL() << "the name is not known";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("--scene sponsor"));
        EXPECT_THAT(error.what(), HasSubstr("gas_station, sponza"));
    }
}

class DescriptionTest : public testing::Test {
protected:
    ~DescriptionTest() override { std::filesystem::remove_all(folder_); }

    /// What is wrong with a description, empty: nothing.
    std::string problem(const std::string& text) {
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / "hall.json") << text;
        try {
            find_benchmark_scene("hall", folder_);
            return {};
        } catch (const UserError& error) {
            return error.what();
        }
    }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / ("benchmark_scene_" + std::to_string(::getpid()));
};

TEST_F(DescriptionTest, ProblemsNameTheMember) {
    EXPECT_EQ(problem(R"({"title": "Hall", "file": "hall.gltf", "exposure": 2})"), "");
    EXPECT_THAT(problem("hall"), HasSubstr("not a JSON object"));
    EXPECT_THAT(problem(R"({"title": "Hall", "file": "hall.gltf"})"),
                HasSubstr("exposure: expected a positive number"));
    EXPECT_THAT(problem(R"({"title": "Hall", "file": "hall.gltf", "exposure": -1})"), HasSubstr("exposure"));
    EXPECT_THAT(problem(R"({"title": "", "file": "hall.gltf", "exposure": 2})"), HasSubstr("title: expected a text"));
    EXPECT_THAT(problem(R"({"title": "Hall", "exposure": 2})"), HasSubstr("file: expected a glTF file"));
    EXPECT_THAT(problem(R"({"title": "Hall", "file": "a.gltf", "exposure": 2, "iso": 100})"), HasSubstr("iso"));
}

} // namespace
} // namespace fieldcast::bench
