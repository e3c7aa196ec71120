// SPDX-License-Identifier: Apache-2.0
#include "server/config/problems.h"

#include "core/base/error.h"
#include "core/base/host_port.h"
#include "core/lightfield/frame_rate.h"
#include "server/access/listening_rule.h"
#include "server/config/limit_problems.h"
#include "server/config/output_files.h"
#include "server/config/recording_problems.h"
#include "server/feed/channel_info.h"
#include "server/service/grpc_version.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

namespace fieldcast::config {

namespace {

using Problems = std::vector<std::string>;

constexpr std::uint32_t kMaxSamples = 65536; // as the wire's RenderSettings
constexpr std::uint32_t kMaxBounces = 256;
constexpr std::size_t kMaxChannels = 64;
constexpr std::size_t kMaxNameBytes = 256;     // of a camera or a device
constexpr std::uint32_t kMaxSourceSide = 8192; // leaves room for a guard band below kMaxPlaneSide

/// Adds "flag: value: what is allowed" unless `is_right`.
template <class T>
void expect(Problems& problems, bool is_right, const char* flag, const T& value, const char* allowed) {
    if (!is_right) {
        std::ostringstream line;
        line << flag << ' ' << value << ": " << allowed;
        problems.push_back(line.str());
    }
}

void check_channels(const Config& config, Problems& problems) {
    if (config.rendering.channels.empty() && config.rendering.replays.empty()) {
        problems.emplace_back(
            "--scene: no scene given; name at least one with --scene FILE or --channel NAME=FILE, or a "
            "recording with --replay FILE");
    }
    expect(problems, config.rendering.channels.size() + config.rendering.replays.size() <= kMaxChannels, "--channel",
           config.rendering.channels.size() + config.rendering.replays.size(), "at most 64 channels");
    std::set<std::string> names;
    for (const channel::ChannelChoice& channel : config.rendering.channels) {
        const bool has_good_length = !channel.name.empty() && channel.name.size() <= feed::kMaxChannelNameBytes;
        expect(problems, has_good_length, "--channel", channel.name, "a name has 1 to 64 bytes");
        expect(problems, names.insert(channel.name).second, "--channel", channel.name,
               "two channels have this name; tell them apart with --channel NAME=FILE");
        std::error_code ignored;
        expect(problems, std::filesystem::is_regular_file(channel.scene, ignored), "--scene", channel.scene.string(),
               "there is no such file");
    }
    std::error_code ignored;
    if (config.rendering.environment && !std::filesystem::is_regular_file(*config.rendering.environment, ignored)) {
        problems.push_back("--environment " + config.rendering.environment->string() +
                           ": there is no such file; or write studio, sky or none");
    }
}

void check_framing(const Config& config, Problems& problems) {
    const scene::FramingOptions& framing = config.rendering.framing;
    const bool is_automatic = config.rendering.camera.empty() || config.rendering.camera == scene::kFramingCamera;
    expect(problems, is_automatic || !framing.any(), "--camera", config.rendering.camera,
           "--look-from, --look-at, --fov and --orbit are for the camera auto; leave --camera out");
    const auto is_place = [](const std::optional<glm::vec3>& place) {
        const glm::vec3 a = glm::abs(place.value_or(glm::vec3(0.0F)));
        return a.x <= 1e9F && a.y <= 1e9F && a.z <= 1e9F;
    };
    expect(problems, is_place(framing.look_from), "--look-from", "", "at most 1e9 metres from the origin");
    expect(problems, is_place(framing.look_at), "--look-at", "", "at most 1e9 metres from the origin");
    expect(problems, !framing.look_from || framing.look_from != framing.look_at, "--look-at", "",
           "another place than --look-from");
    const float fovy = framing.fovy_rad.value_or(1.0F);
    expect(problems, fovy >= 0.0174F && fovy <= 2.9671F, "--fov", fovy * 180.0F / std::numbers::pi_v<float>,
           "1 to 170 degrees");
    const double orbit = framing.orbit_s.value_or(1.0);
    expect(problems, orbit >= 0.1 && orbit <= 86'400.0, "--orbit", orbit, "0.1 to 86400 seconds");
}

void check_lattice(const Config& config, Problems& problems) {
    const auto is_side = [](std::uint32_t px) { return px >= 16 && px <= kMaxSourceSide; };
    expect(problems, is_side(config.rendering.width_px) && is_side(config.rendering.height_px), "--size",
           std::to_string(config.rendering.width_px) + "x" + std::to_string(config.rendering.height_px),
           "16 to 8192 pixels on each side");
    const float fps = config.rendering.frames_per_second;
    expect(problems, is_frame_rate(fps), "--fps", fps, "0.1 to 240");
    check_framing(config, problems);
    const float spacing = config.rendering.spacing_m.value_or(0.0F);
    expect(problems, spacing >= 0.0F && spacing <= 1000.0F, "--spacing", spacing, "0 to 1000 metres");
    expect(problems, config.rendering.lattice.convergence_m > 0.0F, "--convergence",
           config.rendering.lattice.convergence_m, "more than 0 metres, or inf");
    ViewGrid grid = config.rendering.largest_grid;
    if (const auto problem = grid_problem(grid)) {
        problems.push_back("--largest-grid: " + *problem);
    }
    const GuardBand& band = config.rendering.guard_band;
    expect(problems, std::max({band.left_px, band.right_px, band.top_px, band.bottom_px}) <= 2048, "--guard-band",
           "too wide", "at most 2048 pixels on each side");
}

void check_rendering(const Config& config, Problems& problems) {
    const RenderSettings& settings = config.rendering.render;
    expect(problems, settings.samples_per_pixel >= 1 && settings.samples_per_pixel <= kMaxSamples, "--spp",
           settings.samples_per_pixel, "1 to 65536");
    expect(problems,
           settings.light_sampling.candidates >= 1 && settings.light_sampling.candidates <= kMaxLightCandidates,
           "--light-candidates", settings.light_sampling.candidates, "1 to 64");
    expect(problems, settings.max_bounces <= kMaxBounces, "--bounces", settings.max_bounces, "0 to 256");
    expect(problems, settings.temporal_alpha > 0.0F && settings.temporal_alpha <= 1.0F, "--alpha",
           settings.temporal_alpha, "more than 0, at most 1");
    expect(problems, std::isfinite(settings.exposure) && settings.exposure > 0.0F, "--exposure", settings.exposure,
           "'auto' or a number above 0");
    if (config.rendering.sky) {
        const glm::vec3 sky = *config.rendering.sky;
        const float least = std::min({sky.x, sky.y, sky.z});
        expect(problems, std::isfinite(sky.x + sky.y + sky.z) && least >= 0.0F, "--sky", least,
               "finite, not negative radiance");
    }
    expect(problems, config.rendering.camera.size() <= kMaxNameBytes, "--camera", "too long", "at most 256 bytes");
    expect(problems, config.rendering.device.size() <= kMaxNameBytes, "--device", "too long", "at most 256 bytes");
    const double time_s = config.rendering.fixed_time_s.value_or(0.0);
    expect(problems, time_s >= 0.0 && time_s <= 1e6, "--time", time_s, "0 to 1e6 seconds");
    expect(problems, config.rendering.loop_frames == 0 || config.rendering.clock == channel::ClockMode::kFrames,
           "--frames", config.rendering.loop_frames, "only together with --clock frames");
    expect(problems, config.rendering.environment == std::nullopt || config.rendering.sky == std::nullopt, "--sky",
           "with --environment", "give one of the two");
}

void check_serving(const Config& config, Problems& problems) {
    expect(problems, config.listen.port != 0 || config.port_file.has_value(), "--listen", "port 0",
           "only together with --port-file, which tells the port");
    const Problems of_limits = limit_problems(config.limits, config.rendering);
    problems.insert(problems.end(), of_limits.begin(), of_limits.end());
    if (const auto problem = timing::problem_with(config.timing_files, "--frame-log", "--trace")) {
        problems.push_back(*problem);
    }
}

/// Whether one process cannot listen on both.
bool collide(const HostPort& a, const HostPort& b) {
    const auto is_any = [](const std::string& host) { return host == "0.0.0.0" || host == "[::]"; };
    const auto name = [](const std::string& host) { return host == "localhost" ? std::string("127.0.0.1") : host; };
    return a.port != 0 && a.port == b.port && (is_any(a.host) || is_any(b.host) || name(a.host) == name(b.host));
}

/// Runs `check`, which throws UserError.
template <class Check> void expect_usable(Problems& problems, const char* flag, const Check& check) {
    try {
        check();
    } catch (const UserError& problem) {
        problems.push_back(std::string(flag) + " " + problem.what());
    }
}

void check_access(const Config& config, Problems& problems) {
    const access::Security& security = config.security;
    const access::Protection protection{.has_tls = security.certificates.has_value(),
                                        .has_tokens = security.tokens.has_value()};
    if (const auto problem = access::listening_problem(config.listen.host, protection)) {
        problems.push_back("--listen " + to_text(config.listen) + " " + *problem);
    }
    if (const auto problem =
            access::exposure_problem(config.listen.host, service::grpc_version(), security.accepts_known_attacks)) {
        problems.push_back("--listen " + to_text(config.listen) + " " + *problem);
    }
    if (config.metrics_listen) {
        const auto problem = access::listening_problem(config.metrics_listen->host, protection);
        if (problem && !is_loopback(config.metrics_listen->host)) {
            problems.push_back("--metrics-listen " + to_text(*config.metrics_listen) + " " + *problem);
        }
        expect(problems, config.metrics_listen->port != 0 || config.metrics_port_file.has_value(), "--metrics-listen",
               "port 0", "only together with --metrics-port-file, which tells the port");
        expect(problems, !collide(config.listen, *config.metrics_listen), "--metrics-listen",
               to_text(*config.metrics_listen), "--listen has this port, too; take another one");
    }
    if (security.tokens) {
        expect_usable(problems, "--tokens", [&] { access::TokenList::read(*security.tokens); });
    }
    if (security.certificates) {
        const auto now = std::chrono::system_clock::now();
        expect_usable(problems, "--tls-cert", [&] { access::check_certificate(*security.certificates, now); });
    }
}

} // namespace

std::vector<std::string> problems_of(const Config& config) {
    Problems problems;
    check_channels(config, problems);
    check_lattice(config, problems);
    check_rendering(config, problems);
    check_serving(config, problems);
    check_access(config, problems);
    const Problems of_outputs = output_problems(config);
    problems.insert(problems.end(), of_outputs.begin(), of_outputs.end());
    const Problems of_recordings = recording_problems(config.rendering);
    problems.insert(problems.end(), of_recordings.begin(), of_recordings.end());
    return problems;
}

} // namespace fieldcast::config
