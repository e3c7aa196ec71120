// SPDX-License-Identifier: Apache-2.0
// The two programs together, on loopback with the shipped scene: views made by the server and views made by clients
// that hold the scene are the same images, to the last bit, for the same frame (conventions, "What is the same on both
// sides": same binary, driver and device, lossless planes, no view history).
#include "core/gpu/device.h"
#include "core/image/image_file.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <gmock/gmock.h>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace fieldcast::test {
namespace {

namespace fs = std::filesystem;
using std::chrono_literals::operator""s;

constexpr auto kLongestRun = 240s; // two cores, busy, software Vulkan, cold pipeline cache
constexpr auto kEndPatience = 60s; // after Ctrl-C: the picture under way is written
constexpr int kGridSide = 3;

std::set<std::string> frame_folders(const fs::path& folder) {
    std::set<std::string> names;
    if (fs::exists(folder)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            names.insert(entry.path().filename());
        }
    }
    return names;
}

image::Rgba8 read_view(const fs::path& file) {
    const std::string bytes = text_of(file);
    return image::decode_rgba8(std::as_bytes(std::span(bytes)), file, {});
}

class RoundTrip : public testing::Test {
protected:
    void SetUp() override {
        try {
            const gpu::Device device;
        } catch (const gpu::NoDeviceError& error) {
            GTEST_SKIP() << "no Vulkan device: " << error.what();
        }
        ASSERT_TRUE(start_server());
    }

    bool start_server() {
        const fs::path port_file = folder_ / "port";
        server_ = std::make_unique<Program>(
            FIELDCAST_SERVER,
            std::vector<std::string>{"--scene", "scenes/atelier/atelier.gltf", "--size", "160x90", "--fps", "2",
                                     "--clock", "frames", "--largest-grid", "3x3", "--holes",
                                     "isolated,cascade,source,denoise", // no history of views
                                     "--listen", "127.0.0.1:0", "--port-file", port_file},
            folder_ / "server.log");
        const bool is_serving = server_->has_said("SERVING", kLongestRun);
        EXPECT_TRUE(is_serving) << server_->text();
        port_ = is_serving ? std::to_string(std::stoi(text_of(port_file))) : "";
        return is_serving;
    }

    std::unique_ptr<Program> client(const std::string& name, std::vector<std::string> arguments) {
        const std::vector<std::string> all{"--server", "127.0.0.1:" + port_,
                                           "--grid",   "3x3",
                                           "--size",   "160x90",
                                           "--out",    folder_ / name,
                                           "--json",   folder_ / (name + ".json"),
                                           "--cache",  folder_ / "cache"};
        arguments.insert(arguments.begin(), all.begin(), all.end());
        return std::make_unique<Program>(FIELDCAST_CLIENT, arguments, folder_ / (name + ".log"));
    }

    /// Compares every frame that both clients wrote. Returns how many those were.
    int compare(const std::string& one, const std::string& other) {
        int common = 0;
        const std::set<std::string> others = frame_folders(folder_ / other);
        for (const std::string& frame : frame_folders(folder_ / one)) {
            if (others.count(frame) != 0) {
                ++common;
                compare_frame(folder_ / one / frame, folder_ / other / frame);
            }
        }
        return common;
    }

    static void compare_frame(const fs::path& one, const fs::path& other) {
        for (int row = 0; row < kGridSide; ++row) {
            for (int col = 0; col < kGridSide; ++col) {
                const std::string name = "view_r" + std::to_string(row) + "_c" + std::to_string(col) + ".png";
                const image::Rgba8 a = read_view(one / name);
                const image::Rgba8 b = read_view(other / name);
                ASSERT_EQ(a.pixels.size(), b.pixels.size());
                std::size_t different = 0;
                for (std::size_t i = 0; i < a.pixels.size(); ++i) {
                    different += a.pixels[i] != b.pixels[i] ? 1 : 0;
                }
                EXPECT_EQ(different, 0U) << one / name << " of " << a.pixels.size() << " values";
                EXPECT_GT(std::set(a.pixels.begin(), a.pixels.end()).size(), 16U) << one / name << " shows nothing";
            }
        }
    }

    /// Largest over outer views of the frames that both clients wrote: how far `other` is from `one`, compared with how
    /// far the middle view is from it. Negative: no frame reached both. Fails where `other` is black and `one` is not.
    double largest_difference(const std::string& one, const std::string& other) {
        double largest = -1.0;
        const std::set<std::string> others = frame_folders(folder_ / other);
        for (const std::string& frame : frame_folders(folder_ / one)) {
            if (others.count(frame) == 0) {
                continue;
            }
            const image::Rgba8 middle = read_view(folder_ / one / frame / "view_r1_c1.png");
            for (const char* name : {"view_r0_c0.png", "view_r0_c1.png", "view_r1_c2.png", "view_r2_c0.png"}) {
                const image::Rgba8 a = read_view(folder_ / one / frame / name);
                const image::Rgba8 b = read_view(folder_ / other / frame / name);
                largest = std::max(largest, difference(b, a) / difference(middle, a));
                EXPECT_LE(black_beside_none(b, a), 4) << frame << " " << name; // measured 1, where a wire ends
            }
        }
        return largest;
    }

    static double difference(const image::Rgba8& a, const image::Rgba8& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) {
            const double d = static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]);
            sum += d * d;
        }
        return std::sqrt(sum * 4.0 / 3.0 / static_cast<double>(a.pixels.size())); // alpha is always the same
    }

    /// Pixels that are black in `suspect` and have no dark one at or beside their place in `truth`: thin black wires of
    /// the scene move by a pixel.
    static int black_beside_none(const image::Rgba8& suspect, const image::Rgba8& truth) {
        const auto sum = [](const image::Rgba8& image, std::size_t x, std::size_t y) {
            const std::size_t at = 4 * (y * image.width_px + x);
            return image.pixels[at] + image.pixels[at + 1] + image.pixels[at + 2];
        };
        int count = 0;
        for (std::size_t y = 2; y + 2 < suspect.height_px; ++y) {
            for (std::size_t x = 2; x + 2 < suspect.width_px; ++x) {
                int darkest = 3 * 255;
                for (std::size_t i = 0; i < 25; ++i) {
                    darkest = std::min(darkest, sum(truth, x + i % 5 - 2, y + i / 5 - 2));
                }
                count += sum(suspect, x, y) == 0 && darkest > 60 ? 1 : 0;
            }
        }
        return count;
    }

    const TestFolder folder_;
    std::string port_;
    std::unique_ptr<Program> server_;
};

TEST_F(RoundTrip, ViewsAndSceneGiveTheSameImages) {
    const std::vector<std::string> every_frame{"--save", "all", "--write", "views"};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), every_frame.begin(), every_frame.end());
        return arguments;
    };
    const auto thin = client("thin", with({"--mode", "views", "--frames", "0"})); // for as long as the others need
    const auto surfaces = client("surfaces", with({"--mode", "scene", "--planes", "g-buffer", "--frames", "4"}));
    const auto lean = client("lean", with({"--mode", "scene", "--planes", "illumination", "--frames", "4"}));

    EXPECT_EQ(surfaces->exit_code(kLongestRun), 0) << text_of(folder_ / "surfaces.log");
    EXPECT_EQ(lean->exit_code(kLongestRun), 0) << text_of(folder_ / "lean.log");
    thin->send_signal(SIGINT);
    EXPECT_EQ(thin->exit_code(kEndPatience), 130) << text_of(folder_ / "thin.log");

    EXPECT_GE(compare("thin", "surfaces"), 1) << "no frame reached both clients";
    EXPECT_GE(compare("thin", "lean"), 1) << "no frame reached both clients";
    EXPECT_THAT(text_of(folder_ / "thin.json"), testing::HasSubstr("\"failed\": 0"));
    EXPECT_THAT(text_of(folder_ / "lean.json"), testing::HasSubstr("\"sessions\": 1"));
}

TEST_F(RoundTrip, WarpNeedsNoSceneAndGivesAboutTheSameImages) {
    const std::vector<std::string> every_frame{"--save", "all", "--write", "views"};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), every_frame.begin(), every_frame.end());
        return arguments;
    };
    const auto thin = client("thin", with({"--mode", "views", "--frames", "0"})); // for as long as the others need
    const auto exact = client("exact", with({"--mode", "warp", "--frames", "4"}));
    const auto small =
        client("small", with({"--mode", "warp", "--codec", "jpeg,zstd", "--quality", "90", "--frames", "4"}));
    EXPECT_EQ(exact->exit_code(kLongestRun), 0) << text_of(folder_ / "exact.log");
    EXPECT_EQ(small->exit_code(kLongestRun), 0) << text_of(folder_ / "small.log");
    thin->send_signal(SIGINT);
    EXPECT_EQ(thin->exit_code(kEndPatience), 130) << text_of(folder_ / "thin.log");

    const double of_exact = largest_difference("thin", "exact");
    const double of_small = largest_difference("thin", "small");
    EXPECT_GE(of_exact, 0.0) << "no frame reached both clients";
    EXPECT_GE(of_small, 0.0) << "no frame reached both clients";
    EXPECT_LE(of_exact, 0.7); // measured 0.48 to 0.56: wires and leaves thinner than these pixels
    EXPECT_LE(of_small, 0.7); // measured 0.48 to 0.57
    EXPECT_FALSE(fs::exists(folder_ / "cache")) << "it fetched the scene";
}

TEST_F(RoundTrip, RefusalExitsWithTwoAndNamesTheLimit) {
    const auto program = client("huge", {"--fov", "170", "--frames", "1"});
    EXPECT_EQ(program->exit_code(kLongestRun), 2);
    EXPECT_THAT(text_of(folder_ / "huge.log"), testing::HasSubstr("refused"));
}

} // namespace
} // namespace fieldcast::test
