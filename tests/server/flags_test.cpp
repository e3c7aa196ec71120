// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/flags.h"

#include "core/lightfield/presets.h"

#include <array>
#include <fstream>
#include <gmock/gmock.h>
#include <limits>
#include <unistd.h>

namespace fieldcast::command_line {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A file that exists; tests run in the repository root.
constexpr const char* kFile = "CMakeLists.txt";

Invocation read(std::vector<const char*> flags) {
    flags.insert(flags.begin(), "fieldcast-server");
    return read_flags(static_cast<int>(flags.size()), flags.data());
}

TEST(Flags, DefaultsServeOnLoopback) {
    const Invocation invocation = read({"--scene", kFile});
    EXPECT_THAT(invocation.problems, IsEmpty());
    EXPECT_EQ(invocation.kind, Invocation::Kind::kServe);
    const config::Config& config = invocation.config;
    EXPECT_EQ(config.rendering.channels.at(0).name, "CMakeLists");
    EXPECT_EQ(config.listen.host, "127.0.0.1");
    EXPECT_EQ(config.listen.port, 50151);
    EXPECT_EQ(config.rendering.width_px, 1280U);
    EXPECT_EQ(config.rendering.height_px, 720U);
    EXPECT_TRUE(config.rendering.has_auto_exposure);
    EXPECT_TRUE(config.rendering.render.next_event_estimation);
    EXPECT_EQ(config.rendering.lattice.convergence_m, std::numeric_limits<float>::infinity());
}

TEST(Flags, ReadsEverything) {
    const config::Config config = read({"--channel",
                                        "a=CMakeLists.txt",
                                        "--channel",
                                        "b=CMakeLists.txt",
                                        "--sky",
                                        "1,0.5,0",
                                        "--size",
                                        "320x180",
                                        "--fps",
                                        "15",
                                        "--spacing",
                                        "0.05",
                                        "--convergence",
                                        "2.5",
                                        "--spp",
                                        "4",
                                        "--bounces",
                                        "3",
                                        "--no-nee",
                                        "--denoiser",
                                        "none",
                                        "--holes",
                                        "cascade,denoise",
                                        "--exposure",
                                        "1.5",
                                        "--tone-map",
                                        "aces",
                                        "--guard-band",
                                        "1,2,3,4",
                                        "--clock",
                                        "frames",
                                        "--frames",
                                        "30",
                                        "--seed",
                                        "9",
                                        "--listen",
                                        "[::1]:1234",
                                        "--largest-grid",
                                        "4x5",
                                        "--time",
                                        "1.5",
                                        "--fixed-camera",
                                        "--traversal",
                                        "bvh",
                                        "--visibility",
                                        "raster"})
                                      .config;
    EXPECT_EQ(config.rendering.channels.size(), 2U);
    EXPECT_EQ(config.rendering.sky, glm::vec3(1.0F, 0.5F, 0.0F));
    EXPECT_EQ(config.rendering.width_px, 320U);
    EXPECT_EQ(config.rendering.frames_per_second, 15.0F);
    EXPECT_EQ(config.rendering.spacing_m, 0.05F);
    EXPECT_EQ(config.rendering.lattice.convergence_m, 2.5F);
    EXPECT_EQ(config.rendering.render.samples_per_pixel, 4U);
    EXPECT_FALSE(config.rendering.render.next_event_estimation);
    EXPECT_EQ(config.rendering.render.denoiser, Denoiser::kNone);
    EXPECT_EQ(config.rendering.render.holes, (HoleFilling{false, false, 4, 5, false, true}));
    EXPECT_EQ(config.rendering.render.exposure, 1.5F);
    EXPECT_EQ(config.rendering.render.tone_map, ToneMap::kAces);
    EXPECT_EQ(config.rendering.guard_band.bottom_px, 4U);
    EXPECT_EQ(config.rendering.clock, channel::ClockMode::kFrames);
    EXPECT_EQ(config.rendering.loop_frames, 30U);
    EXPECT_EQ(config.listen.host, "[::1]");
    EXPECT_EQ(config.rendering.largest_grid.cols, 5U);
    EXPECT_EQ(config.rendering.fixed_time_s, 1.5);
}

TEST(Flags, RecordsAndReplays) {
    const Invocation both =
        read({"--scene", kFile, "--record", "out.fcrec", "--record-form", "views:3x3", "--record-form",
              "g-buffer:jpeg:50", "--record-frames", "9", "--replay", "again=README.md", "--replay-fps", "2.5"});
    EXPECT_THAT(both.problems, IsEmpty());
    EXPECT_EQ(both.config.rendering.records.at(0).file, "out.fcrec");
    EXPECT_EQ(both.config.rendering.record_frames, 9U);
    EXPECT_EQ(both.config.rendering.record_forms.at(1).quality, 50);
    EXPECT_EQ(both.config.rendering.replays.at(0).name, "again");
    EXPECT_EQ(both.config.rendering.replays.at(0).file, "README.md");
    EXPECT_EQ(both.config.rendering.replays.at(0).frames_per_second, 2.5F);
    EXPECT_THAT(read({"--replay", kFile}).problems, IsEmpty()) << "a replay needs no scene";
}

TEST(Flags, RefusesRecordingsThatCannotBe) {
    EXPECT_THAT(read({"--replay", "nowhere.fcrec"}).problems,
                Contains(HasSubstr("--replay nowhere.fcrec: there is no")));
    EXPECT_THAT(read({"--replay", kFile, "--replay-fps", "0"}).problems, Contains(HasSubstr("--replay-fps")));
    EXPECT_THAT(read({"--scene", kFile, "--record-form", "views:3"}).problems,
                Contains(HasSubstr("--record-form views:3: write views")));
    EXPECT_THAT(read({"--replay", kFile, "--record", "a.fcrec"}).problems, Contains(HasSubstr("--record a.fcrec")));
    EXPECT_THAT(read({"--channel", "a=README.md", "--channel", "b=README.md", "--record", "c=x.fcrec"}).problems,
                Contains(HasSubstr("there is no scene's channel 'c'")));
    EXPECT_THAT(read({"record", "--channel", "a=README.md", "--channel", "b=README.md"}).problems,
                Contains(HasSubstr("exactly one scene")));
    const Invocation job = read({"record", "--scene", kFile, "--out", "a.fcrec", "--count", "7"});
    EXPECT_THAT(job.problems, IsEmpty());
    EXPECT_EQ(job.kind, Invocation::Kind::kRecord);
    EXPECT_EQ(job.record_job.frame_count, 7U);
}

TEST(Flags, SayWhoSteersWhichCamera) {
    const Invocation all = read({"--channel", "a=CMakeLists.txt", "--channel", "b=CMakeLists.txt", "--camera-control",
                                 "b=scripted", "--camera-control", "steered", "--steering-lease", "1.5"});
    EXPECT_THAT(all.problems, IsEmpty());
    EXPECT_EQ(all.config.rendering.channels.at(0).control, feed::CameraControl::kSteered);
    EXPECT_EQ(all.config.rendering.channels.at(1).control, std::nullopt) << "what is said of one channel wins";
    EXPECT_EQ(all.config.rendering.steering_lease, std::chrono::milliseconds(1500));
    EXPECT_THAT(read({"--scene", kFile, "--camera-control", "c=steered"}).problems, Contains(HasSubstr("no channel")));
    EXPECT_THAT(read({"--scene", kFile, "--camera-control", "driven"}).problems,
                Contains(HasSubstr("scripted, steered or own")));
    EXPECT_THAT(read({"--scene", kFile, "--steering-lease", "0.1"}).problems, Contains(HasSubstr("0.5 to 3600")));
    EXPECT_THAT(read({"--scene", kFile, "--steering-lease", "nan"}).problems, Contains(HasSubstr("--steering-lease")));
}

TEST(Flags, GiveEveryClientACamera) {
    const Invocation all =
        read({"--scene", kFile, "--camera-control", "own", "--max-own-cameras", "7", "--own-camera-budget", "250"});
    EXPECT_THAT(all.problems, IsEmpty());
    EXPECT_EQ(all.config.rendering.channels.at(0).control, feed::CameraControl::kOwn);
    EXPECT_EQ(all.config.limits.max_own_cameras, 7U);
    EXPECT_EQ(all.config.rendering.own_cameras.max_ms_per_second, 250.0);
    EXPECT_THAT(read({"--scene", kFile, "--max-own-cameras", "0"}).problems,
                Contains(HasSubstr("--max-own-cameras 0: 1 to")));
    EXPECT_EQ(read({"--scene", kFile, "--max-own-cameras-per-peer", "2"}).config.limits.max_own_cameras_per_peer, 2U);
    EXPECT_THAT(read({"--scene", kFile, "--max-own-cameras-per-peer", "0"}).problems,
                Contains(HasSubstr("--max-own-cameras-per-peer 0: 1 to")));
    EXPECT_THAT(read({"--scene", kFile, "--own-camera-budget", "0"}).problems,
                Contains(HasSubstr("--own-camera-budget 0: 1 to")));
    EXPECT_THAT(read({"--scene", kFile, "--camera-control", "own", "--record", "a.fcrec"}).problems,
                Contains(HasSubstr("--record a.fcrec: with --camera-control own every client")));
    EXPECT_THAT(read({"--channel", "a=README.md", "--channel", "b=README.md", "--camera-control", "a=own", "--record",
                      "b=b.fcrec"})
                    .problems,
                IsEmpty());
}

TEST(Flags, RefusesToListenForTheWorld) {
    for (const char* const listen : {"0.0.0.0:50151", "192.168.1.4:50151", "[::]:50151", "example.org:80"}) {
        EXPECT_THAT(read({"--scene", kFile, "--listen", listen}).problems, Contains(HasSubstr("loopback"))) << listen;
        EXPECT_THAT(read({"--scene", kFile, "--listen", listen}).problems, Contains(HasSubstr("deploy/envoy.yaml")));
        EXPECT_THAT(read({"--scene", kFile, "--accept-known-grpc-attacks", "--listen", listen}).problems,
                    Not(Contains(HasSubstr("gRPC"))));
    }
}

TEST(Flags, MetricsStayOnLoopbackToo) {
    EXPECT_THAT(read({"--scene", kFile, "--metrics-listen", "0.0.0.0:9"}).problems,
                Contains(HasSubstr("--metrics-listen 0.0.0.0:9")));
    EXPECT_THAT(read({"--scene", kFile, "--metrics-listen", "127.0.0.1:0"}).problems,
                Contains(HasSubstr("--metrics-port-file")));
    const Invocation good = read({"--scene", kFile, "--metrics-listen", "127.0.0.1:9", "--log-format", "json"});
    EXPECT_TRUE(good.problems.empty());
    EXPECT_EQ(good.config.metrics_listen->port, 9);
    EXPECT_EQ(good.config.log_format, log::Format::kJson);
    EXPECT_THAT(read({"--scene", kFile, "--log-format", "xml"}).problems, Contains(HasSubstr("--log-format")));
}

TEST(Flags, ReadsAndChecksLimits) {
    const config::Config config =
        read({"--scene", kFile, "--max-sessions-per-peer", "3", "--max-bytes-in-flight-in-total", "1000",
              "--max-opens-per-second-per-peer", "0.5"})
            .config;
    EXPECT_EQ(config.limits.max_sessions_per_peer, 3U);
    EXPECT_EQ(config.limits.max_bytes_in_flight_in_total, 1000U);
    EXPECT_EQ(config.limits.max_opens_per_second_per_peer, 0.5);
    const auto problems =
        read({"--scene", kFile, "--max-scene-downloads", "0", "--max-messages-per-second", "1", "--max-pixels-per-peer",
              "18446744073709551615", "--max-opens-per-second-per-peer", "nan"})
            .problems;
    for (const char* const flag : {"--max-scene-downloads 0", "--max-messages-per-second 1",
                                   "--max-pixels-per-peer 1844", "--max-opens-per-second-per-peer nan"}) {
        EXPECT_THAT(problems, Contains(HasSubstr(flag)));
    }
}

TEST(Flags, ProbesOfHealthSendTokensEncryptedOnly) {
    const Invocation probe = read({"--health", "https://example.org:5"});
    EXPECT_EQ(probe.kind, Invocation::Kind::kHealth);
    EXPECT_TRUE(probe.health.uses_tls);
    EXPECT_EQ(probe.health.address.port, 5);
    EXPECT_THAT(read({"--health", "nowhere"}).problems, Contains(HasSubstr("HOST:PORT")));
    const std::string file = testing::TempDir() + "health_token_" + std::to_string(::getpid());
    EXPECT_THAT(read({"--health", "localhost:5", "--health-token-file", file.c_str()}).problems,
                Contains(HasSubstr("cannot be read")));
    std::ofstream(file) << "fc_secret\n";
    EXPECT_EQ(read({"--health", "localhost:5", "--health-token-file", file.c_str()}).health.token, "fc_secret");
    EXPECT_THAT(read({"--health", "example.org:5", "--health-token-file", file.c_str()}).problems,
                Contains(HasSubstr("unencrypted")));
    std::filesystem::remove(file);
}

TEST(Flags, ReportsAccessFilesThatCannotBeUsed) {
    EXPECT_THAT(read({"--scene", kFile, "--tls-cert", kFile}).problems,
                Contains(HasSubstr("--tls-cert needs --tls-key")));
    EXPECT_THAT(read({"--scene", kFile, "--tls-key", kFile}).problems,
                Contains(HasSubstr("--tls-key needs --tls-cert")));
    EXPECT_THAT(read({"--scene", kFile, "--tls-client-ca", kFile}).problems,
                Contains(HasSubstr("--tls-client-ca needs")));
    EXPECT_THAT(read({"--scene", kFile, "--tls-cert", kFile, "--tls-key", kFile}).problems,
                Contains(HasSubstr("contains no certificate")));
    EXPECT_THAT(read({"--scene", kFile, "--tokens", kFile}).problems, Contains(HasSubstr("CMakeLists.txt:2: ")));
    EXPECT_THAT(read({"--scene", kFile, "--tokens", "absent.txt"}).problems,
                Contains(HasSubstr("absent.txt: cannot be read")));
}

TEST(Flags, KnowsEveryDenoiser) {
    constexpr std::array kWords{std::pair("svgf+", Denoiser::kSvgfPlus), std::pair("svgf", Denoiser::kSvgf),
                                std::pair("bmfr", Denoiser::kBmfr), std::pair("none", Denoiser::kNone)};
    for (const auto& [word, denoiser] : kWords) {
        const Invocation invocation = read({"--scene", kFile, "--denoiser", word});
        EXPECT_TRUE(invocation.problems.empty()) << word;
        EXPECT_EQ(invocation.config.rendering.render.denoiser, denoiser) << word;
    }
}

TEST(Flags, SlowerThanTheSlowestRateIsNamed) {
    for (const char* const rate : {"0.004", "1e-30", "nan", "inf", "-1"}) {
        EXPECT_THAT(read({"--scene", kFile, "--fps", rate}).problems, ElementsAre(HasSubstr("0.1 to 240"))) << rate;
        EXPECT_THAT(read({"--scene", kFile, "--replay", kFile, "--replay-fps", rate}).problems,
                    Contains(AllOf(HasSubstr("--replay-fps"), HasSubstr("0.1 to 240"))))
            << rate;
    }
    EXPECT_THAT(read({"--scene", kFile, "--fps", "0.1"}).problems, IsEmpty());
}

TEST(Flags, ReportsAllProblemsAtOnce) {
    const auto problems = read({"--scene", "/no/such.gltf", "--fps", "0", "--spp", "0", "--alpha", "2"}).problems;
    EXPECT_EQ(problems.size(), 4U);
}

TEST(Flags, ReportsTextItCannotRead) {
    const auto problems = read({"--scene",    kFile,    "--size",  "big",  "--sky",    "1,2",  "--exposure",   "bright",
                                "--denoiser", "magic",  "--holes", "deep", "--listen", "here", "--guard-band", "1,2",
                                "--channel",  "nofile", "--clock", "sun"})
                              .problems;
    EXPECT_EQ(problems.size(), 9U);
}

TEST(Flags, NeedsAScene) {
    EXPECT_THAT(read({}).problems, Contains(HasSubstr("--scene")));
}

TEST(Flags, NeedsDifferentChannelNames) {
    EXPECT_THAT(read({"--scene", kFile, "--scene", kFile}).problems, Contains(HasSubstr("two channels")));
}

TEST(Flags, PortZeroNeedsAPortFile) {
    EXPECT_THAT(read({"--scene", kFile, "--listen", "127.0.0.1:0"}).problems, Contains(HasSubstr("--port-file")));
    EXPECT_THAT(read({"--scene", kFile, "--listen", "127.0.0.1:0", "--port-file", "p"}).problems, IsEmpty());
}

TEST(Flags, UnknownFlagsAreProblems) {
    EXPECT_THAT(read({"--scene", kFile, "--colour"}).problems, Contains(HasSubstr("--colour")));
    EXPECT_THAT(read({"--scene", kFile, "--max-sesions", "3"}).problems,
                Contains(HasSubstr("did you mean --max-sessions?")));
    EXPECT_THAT(read({"--scene", kFile, "dangling"}).problems, Contains(HasSubstr("dangling")));
}

TEST(Flags, HelpHasExamplesAndEveryGroup) {
    const Invocation help = read({"--help"});
    EXPECT_THAT(help.problems, IsEmpty());
    EXPECT_EQ(help.kind, Invocation::Kind::kPrint);
    for (const char* const part : {"Examples:", "Scene:", "Light field:", "Rendering:", "Serving:", "Limits:",
                                   "Security:"}) {
        EXPECT_THAT(help.text, HasSubstr(part));
    }
}

TEST(Flags, PrintsAConfigFileThatItReads) {
    const Invocation printed = read({"--scene", kFile, "--fps", "12", "--no-nee", "--print-config"});
    EXPECT_THAT(printed.text, HasSubstr("fps = 12\n"));
    const std::string file = testing::TempDir() + "server_flags_" + std::to_string(::getpid()) + ".toml";
    std::ofstream(file) << printed.text;
    const Invocation again = read({"--config", file.c_str()});
    EXPECT_THAT(again.problems, IsEmpty()) << printed.text;
    EXPECT_EQ(again.config.rendering.frames_per_second, 12.0F);
    EXPECT_FALSE(again.config.rendering.render.next_event_estimation);
    EXPECT_EQ(again.config.rendering.channels.size(), 1U);
}

TEST(Flags, APresetGivesDefaultsThatOtherFlagsReplace) {
    const channel::Settings paper = read({"--scene", kFile, "--preset", "paper"}).config.rendering;
    EXPECT_EQ(paper.render, find_preset("paper", 6, 6)->settings);
    EXPECT_EQ(paper.guard_band_mode, channel::GuardBandMode::kFixed);
    const channel::Settings other =
        read({"--scene", kFile, "--preset", "paper", "--accumulate-views", "off", "--denoise", "views", "--denoiser",
              "svgf+", "--holes", "cascade", "--guard-band", "auto"})
            .config.rendering;
    EXPECT_FALSE(other.render.accumulate_views);
    EXPECT_EQ(other.render.denoised_images, DenoisedImages::kViews);
    EXPECT_EQ(other.render.denoiser, Denoiser::kSvgfPlus);
    EXPECT_EQ(other.render.holes.cascade_rows, 6U);
    EXPECT_EQ(other.render.light_sampling, LightSampling::plain()); // the preset's
    EXPECT_EQ(other.guard_band_mode, channel::GuardBandMode::kAuto);
    EXPECT_EQ(read({"--scene", kFile}).config.rendering.render, find_preset("default", 6, 6)->settings);
    EXPECT_THAT(read({"--scene", kFile, "--preset", "best"}).problems,
                Contains(HasSubstr("--preset best: one of reprojected")));
    EXPECT_THAT(read({"--scene", kFile, "--denoise", "blue"}).problems, Contains(HasSubstr("--denoise blue")));
}

TEST(Flags, PrintsAPresetThatItReads) {
    const Invocation printed = read({"--scene", kFile, "--preset", "paper", "--alpha", "0.5", "--print-config"});
    EXPECT_THAT(printed.text, AllOf(HasSubstr("preset = \"paper\"\n"), HasSubstr("accumulate-views = \"on\"\n")));
    const std::string file = testing::TempDir() + "server_preset_" + std::to_string(::getpid()) + ".toml";
    std::ofstream(file) << printed.text;
    const Invocation again = read({"--config", file.c_str()});
    EXPECT_THAT(again.problems, IsEmpty()) << printed.text;
    EXPECT_EQ(again.config.rendering.render, printed.config.rendering.render);
}

} // namespace
} // namespace fieldcast::command_line
