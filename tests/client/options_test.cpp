// SPDX-License-Identifier: Apache-2.0
#include "client/options.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using client::Invocation;
using testing::HasSubstr;

Invocation read(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "fieldcast-client");
    return client::read_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, ReadTheCommandOfTheReadme) {
    const Invocation invocation =
        read({"--server", "127.0.0.1:9", "--grid", "4x5", "--mode", "scene", "--size", "640x360", "--frames", "3",
              "--out", "o", "--write", "quilt,exr", "--cache", "c", "--planes", "illumination"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    const client::play::PlayOptions& play = invocation.options->play;
    EXPECT_EQ(play.server.address, "127.0.0.1:9");
    EXPECT_EQ(play.request.rows, 4U);
    EXPECT_EQ(play.request.cols, 5U);
    EXPECT_EQ(play.request.width_px, 640U);
    EXPECT_EQ(play.request.height_px, 360U);
    EXPECT_EQ(play.request.mode, DeliveryMode::kScene);
    EXPECT_EQ(play.request.planes, PlaneSet::kIllumination);
    EXPECT_EQ(play.frames, 3U);
    EXPECT_TRUE(play.products.source_exr);
    EXPECT_FALSE(play.products.views);
    EXPECT_FALSE(invocation.options->falls_back_to_views);
}

TEST(Options, ReadHowToSteer) {
    for (const char* const path : {"orbit", "orbit:radius=2,seconds=10", "-"}) {
        const Invocation invocation = read({"--steer", path});
        ASSERT_TRUE(invocation.options) << invocation.text;
        ASSERT_TRUE(invocation.options->play.steering.has_value());
        EXPECT_TRUE(invocation.options->play.steering->waits);
    }
    EXPECT_FALSE(read({"--steer", "orbit", "--steer-now"}).options->play.steering->waits);
    EXPECT_FALSE(read({}).options->play.steering.has_value());
    const Invocation wrong = read({"--steer", "orbit:radius=0"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.text, HasSubstr("radius"));
}

TEST(Options, ReadHowToReachAProtectedServer) {
    const Invocation invocation = read({"--server", "https://host:9", "--tls-ca", "ca.pem", "--tls-cert", "c.pem",
                                        "--tls-key", "k.pem", "--tls-name", "render1", "--token-file", "t.txt"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    const client::play::ServerOptions& server = invocation.options->play.server;
    EXPECT_EQ(server.address, "host:9");
    EXPECT_TRUE(server.access.uses_tls);
    EXPECT_EQ(server.access.tls_ca, "ca.pem");
    EXPECT_EQ(server.access.tls_certificate, "c.pem");
    EXPECT_EQ(server.access.tls_key, "k.pem");
    EXPECT_EQ(server.access.tls_name, "render1");
    EXPECT_EQ(server.access.token_file, "t.txt");
}

TEST(Options, ASecondModeIsTheFallBack) {
    const Invocation invocation = read({"--mode", "scene,views"});
    ASSERT_TRUE(invocation.options);
    EXPECT_TRUE(invocation.options->falls_back_to_views);
}

TEST(Options, WarpNeedsNoSceneAndHasAResidualLayerUnlessToldOtherwise) {
    const Invocation invocation = read({"--mode", "warp,views", "--codec", "jpeg,zstd"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    EXPECT_EQ(invocation.options->play.request.mode, DeliveryMode::kWarp);
    EXPECT_TRUE(invocation.options->play.request.has_residual);
    EXPECT_TRUE(invocation.options->falls_back_to_views);
    EXPECT_TRUE(invocation.options->play.cache_folder.empty());
    EXPECT_FALSE(read({"--mode", "warp", "--no-residual"}).options->play.request.has_residual);
    EXPECT_EQ(read({"--mode", "warp", "--write", "exr"}).exit_code, 2);
}

TEST(Options, IlluminationMayBeOnePlane) {
    const Invocation invocation =
        read({"--mode", "scene", "--planes", "total-light", "--change", "3s:planes=g-buffer"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    EXPECT_EQ(invocation.options->play.request.planes, PlaneSet::kTotalLight);
    EXPECT_EQ(invocation.options->play.changes.at(0).request.planes, PlaneSet::kWithGBuffer);
    const Invocation wrong = read({"--change", "3s:planes=light"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.text, HasSubstr("write illumination, g-buffer or total-light"));
}

TEST(Options, NormalsHave16Or8BitsAComponent) {
    EXPECT_FALSE(read({"--mode", "scene"}).options->play.request.has_coarse_normals);
    EXPECT_TRUE(read({"--mode", "scene", "--normal-bits", "8"}).options->play.request.has_coarse_normals);
    EXPECT_EQ(read({"--mode", "scene", "--normal-bits", "12"}).exit_code, 2);
}

TEST(Options, UnsetValuesAreLeftToTheChannel) {
    const Invocation invocation = read({});
    ASSERT_TRUE(invocation.options);
    const client::net::Request& request = invocation.options->play.request;
    EXPECT_EQ(request.width_px, 0U);
    EXPECT_FALSE(request.spacing_m);
    EXPECT_FALSE(request.convergence_m);
    EXPECT_EQ(request.fovy_rad, 0.0F);
}

TEST(Options, CodecsKeepTheirOrder) {
    const Invocation invocation = read({"--codec", "jpeg,zstd", "--quality", "40"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    EXPECT_THAT(invocation.options->play.request.codecs,
                testing::ElementsAre(Codec::kJpeg, Codec::kZstdFiltered));
    EXPECT_EQ(invocation.options->play.request.quality, 40);
    const Invocation video = read({"--codec", "h264,jpeg"});
    ASSERT_TRUE(video.options) << video.text;
    EXPECT_THAT(video.options->play.request.codecs, testing::ElementsAre(Codec::kH264, Codec::kJpeg));
}

TEST(Options, WrongInputExitsWithTwoAndNamesTheFlag) {
    const std::vector<std::vector<const char*>> wrong{
        {"--grid", "9x9"},        {"--grid", "x"},    {"--size", "640"},  {"--size", "0x5"},
        {"--mode", "magic"},      {"--write", "exr"},                                             // needs mode scene
        {"--fov", "180"},         {"--save", "some"}, {"--frames", "-1"}, {"--tls-ca", "ca.pem"}, // needs --tls
        {"--tls-cert", "c.pem"},                                                                  // needs --tls-key
        {"--server", "ftp://h:1"}, {"--codec", "gif"}, {"--quality", "0"}, {"--quality", "101"},
        {"--max-fps", "0.004"},    {"--max-fps", "1e-30"}, {"--max-fps", "nan"}, {"--max-fps", "inf"},
        {"--max-fps", "-1"}};
    for (const auto& arguments : wrong) {
        const Invocation invocation = read(arguments);
        EXPECT_FALSE(invocation.options) << arguments[0] << ' ' << arguments[1];
        EXPECT_EQ(invocation.exit_code, 2);
        EXPECT_THAT(invocation.text, HasSubstr(arguments[0]));
    }
}

TEST(Options, HelpHasExamplesAndExitsWithZero) {
    const Invocation invocation = read({"--help"});
    EXPECT_FALSE(invocation.options);
    EXPECT_EQ(invocation.exit_code, 0);
    EXPECT_THAT(invocation.text, HasSubstr("Examples:"));
}

TEST(Options, ChangesBuildOnEachOther) {
    const Invocation invocation = read({"--grid", "3x3", "--change", "3s:grid=5x5,quality=40,codec=jpeg+zstd",
                                        "--change", "20f:mode=scene,size=320x180", "--cache", "c"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    const client::play::PlayOptions& play = invocation.options->play;
    EXPECT_EQ(play.request.rows, 3U);
    ASSERT_EQ(play.changes.size(), 2U);
    EXPECT_EQ(play.changes[0].moment.after, std::chrono::milliseconds(3000));
    EXPECT_EQ(play.changes[0].request.rows, 5U);
    EXPECT_EQ(play.changes[0].request.quality, 40U);
    EXPECT_THAT(play.changes[0].request.codecs,
                testing::ElementsAre(Codec::kJpeg, Codec::kZstdFiltered));
    EXPECT_EQ(play.changes[1].moment.frames, 20U);
    EXPECT_EQ(play.changes[1].request.mode, DeliveryMode::kScene);
    EXPECT_EQ(play.changes[1].request.rows, 5U) << "as the change before left it";
    EXPECT_EQ(play.changes[1].request.height_px, 180U);
    EXPECT_EQ(play.cache_folder, "c") << "the change needs the scene";
}

TEST(Options, ChangesThatCannotBeReadAreNamed) {
    for (const auto& [text, words] :
         {std::pair("3s", "WHEN:KEY=VALUE"), std::pair("3x:grid=2x2", "is not a time"), std::pair("3s:grid=2",
                    "grid=2: write"),
          std::pair("3s:colour=red", "one of the keys anchor"), std::pair("3s:quality=101", "quality=101"),
          std::pair("-1s:grid=2x2", "is not a time"), std::pair("3s:max-fps=0.004",
                    "max-fps=0.004: write 0, or a number"),
          std::pair("3s:max-fps=nan", "max-fps=nan: write 0, or a number")}) {
        const Invocation invocation = read({"--change", text});
        EXPECT_FALSE(invocation.options) << text;
        EXPECT_EQ(invocation.exit_code, 2);
        EXPECT_THAT(invocation.text, HasSubstr(words));
    }
}

TEST(Options, FilesOfTimingsSayTheirFormByTheirName) {
    EXPECT_TRUE(read({"--frame-log", "a.csv", "--trace", "b.json"}).options);
    EXPECT_THAT(read({"--frame-log", "a.txt"}).text, HasSubstr(".jsonl"));
}

TEST(Options, AdaptationIsOffUnlessAskedFor) {
    EXPECT_FALSE(read({}).options->play.request.adaptation);
    const Invocation usual = read({"--adapt", "--frames", "3"});
    ASSERT_TRUE(usual.options) << usual.text;
    ASSERT_TRUE(usual.options->play.request.adaptation);
    EXPECT_TRUE(usual.options->play.request.adaptation->allows_jpeg);
    EXPECT_EQ(usual.options->play.request.adaptation->min_rows, 3U);
    const Invocation own = read({"--adapt", "jpeg=off,quality=0,fps=5,height=90,grid=2x1,delay=250"});
    ASSERT_TRUE(own.options) << own.text;
    const client::net::AdaptationBounds& request = *own.options->play.request.adaptation;
    EXPECT_FALSE(request.allows_jpeg);
    EXPECT_EQ(request.min_quality, 0U);
    EXPECT_EQ(request.min_frames_per_second, 5.0F);
    EXPECT_EQ(request.min_view_height_px, 90U);
    EXPECT_EQ(request.min_rows, 2U);
    EXPECT_EQ(request.min_cols, 1U);
    EXPECT_EQ(request.max_queue_delay_ms, 250U);
    EXPECT_THAT(read({"--adapt", "fps=0.05"}).text, HasSubstr("fps=0.05: write 0, or a number"));
    EXPECT_THAT(read({"--adapt", "speed=3"}).text, HasSubstr("one of the keys delay"));
}

} // namespace
} // namespace fieldcast::test
