// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/flags.h"
#include "tests/fixtures/test_folder.h"

#include "core/base/error.h"

#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace fieldcast::command_line {
namespace {

using testing::HasSubstr;
using testing::Not;

Invocation read(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "fieldcast-server");
    return read_flags(static_cast<int>(arguments.size()), arguments.data());
}

constexpr const char* kScene = "scenes/atelier/atelier.gltf";

TEST(Inspect, TellsWhatIsInTheDemoScene) {
    const auto report = nlohmann::json::parse(inspect({.file = kScene, .as_json = true}));
    EXPECT_GT(report["triangles"], 1000);
    EXPECT_GE(report["triangles_shown"], report["triangles"]);
    EXPECT_EQ(report["cameras"][0]["name"], "LightField");
    EXPECT_GT(report["cameras"][0]["spacing_m"], 0.0);
    EXPECT_EQ(report["environment"], "sky") << "it has lights";
    EXPECT_FALSE(report["extensions"].empty());
    EXPECT_TRUE(report["extensions"][0]["is_read"]);
    EXPECT_GT(report["memory_bytes"], 100'000);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(report["extent_m"]["low"][axis], report["extent_m"]["high"][axis]);
    }
    const std::string text = inspect({.file = kScene});
    EXPECT_THAT(text, HasSubstr("0 LightField"));
    EXPECT_THAT(text, HasSubstr("camera auto   "));
}

TEST(Inspect, NamesOfTheFileDoNotReachTheTerminalAsCommands) {
    const test::TestFolder folder;
    std::ofstream(folder / "a.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "name": "\u001b[2Jcam"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                       "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    const std::string text = inspect({.file = folder / "a.gltf"});
    EXPECT_THAT(text, HasSubstr("[2Jcam"));
    EXPECT_THAT(text, Not(HasSubstr("\x1b")));
    EXPECT_THAT(text, HasSubstr("environment studio"));
    EXPECT_THAT(inspect({.file = folder / "a.gltf", .as_json = true}), Not(HasSubstr("\x1b")));
}

TEST(Inspect, IsAskedForByAWord) {
    const Invocation asked = read({"inspect", "a.glb", "--json"});
    EXPECT_EQ(asked.kind, Invocation::Kind::kInspect);
    EXPECT_EQ(asked.inspect_job.file, "a.glb");
    EXPECT_TRUE(asked.inspect_job.as_json);
    EXPECT_THAT(read({"inspect"}).problems, testing::ElementsAre(HasSubstr("name a file")));
    EXPECT_THAT(read({"inspect", "--help"}).text, HasSubstr("Examples:"));
    EXPECT_THROW(inspect({.file = "absent.glb"}), UserError);
}

TEST(Inspect, ListsTheCamerasThatTheCameraFlagAccepts) {
    const Invocation asked = read({"--scene", kScene, "--list-cameras"});
    EXPECT_EQ(asked.kind, Invocation::Kind::kPrint);
    EXPECT_THAT(asked.text, HasSubstr("atelier.gltf:\n  0 LightField"));
    EXPECT_THAT(read({"--list-cameras"}).problems, testing::Contains(HasSubstr("no scene given")));
}

TEST(Inspect, AWordThatIsNoTaskIsToldWhatMayBeMeant) {
    EXPECT_THAT(read({"rendr", "--scene", kScene}).problems,
                testing::Contains(HasSubstr("rendr: belongs to no flag; did you mean render?")));
    EXPECT_THAT(read({kScene}).problems, testing::Contains(HasSubstr("did you mean --scene " + std::string(kScene))));
    EXPECT_THAT(read({"quux"}).problems, testing::Contains("quux: belongs to no flag"));
}

} // namespace
} // namespace fieldcast::command_line
