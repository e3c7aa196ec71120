// SPDX-License-Identifier: Apache-2.0
#include "server/ops/flags.h"

#include "server/ops/flag_text.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace fieldcast::ops {

namespace {

constexpr const char* kExamples = R"(Examples:
  fieldcast-server --scene scenes/atelier/atelier.gltf
  fieldcast-server --scene hall.glb --environment noon.exr --size 640x360 --fps 15
  fieldcast-server --channel red=a.gltf --channel blue=b.gltf --listen 127.0.0.1:0 --port-file port.txt
  fieldcast-server --scene a.gltf --clock frames --frames 30 --seed 7        # the same 30 frames again and again

TERM or INT: drain, then stop. Again: stop at once. Exit codes: 0 ok, 1 the machine failed, 2 wrong input.)";

void add_scene_flags(CLI::App& app, FlagText& text, Config& config) {
    app.add_option("--scene", text.scenes, "A .gltf or .glb file; its channel is named after it. May be repeated")
        ->group("Scene");
    app.add_option("--channel", text.channels, "NAME=FILE: a channel of that name. May be repeated")->group("Scene");
    app.add_option("--environment", text.environment, "Equirectangular .hdr or .exr for all channels")->group("Scene");
    app.add_option("--sky", text.sky, "R,G,B: linear radiance of the sky without an environment")->group("Scene");
    app.add_option("--camera", config.camera, "Camera node; default: LightField, else the first")->group("Scene");
    app.add_flag("--fixed-camera", config.has_fixed_camera, "The camera stays where it is at the start")
        ->group("Scene");
    app.add_option("--time", config.fixed_time_s, "Freezes the scene at that time, seconds")->group("Scene");
    app.add_option("--clock", text.clock, "real: wall clock. frames: 1/fps per rendered frame")
        ->group("Scene")
        ->capture_default_str();
    app.add_option("--frames", config.loop_frames, "With --clock frames: start again after so many; 0: never")
        ->group("Scene")
        ->capture_default_str();
}

void add_image_flags(CLI::App& app, FlagText& text, Config& config) {
    app.add_option("--size", text.size, "Source image, pixels")->group("Light field")->capture_default_str();
    app.add_option("--fps", config.frames_per_second, "Frames per second at most")
        ->group("Light field")
        ->capture_default_str();
    app.add_option("--spacing", config.spacing_m,
                   "Distance of neighbouring views, metres; default: the camera's, or 0.03")
        ->group("Light field");
    app.add_option("--convergence", text.convergence, "Depth of zero disparity, metres; inf: parallel cameras")
        ->group("Light field")
        ->capture_default_str();
    app.add_option("--largest-grid", text.largest_grid, "ROWSxCOLS that the guard band is made for")
        ->group("Light field")
        ->capture_default_str();
    app.add_option("--guard-band", text.guard_band, "auto, none, or LEFT,RIGHT,TOP,BOTTOM in pixels")
        ->group("Light field")
        ->capture_default_str();
}

void add_render_flags(CLI::App& app, FlagText& text, Config& config) {
    RenderSettings& settings = config.settings;
    app.add_option("--spp", settings.samples_per_pixel, "Samples per pixel")->group("Rendering")->capture_default_str();
    app.add_option("--bounces", settings.max_bounces, "Bounces at most")->group("Rendering")->capture_default_str();
    app.add_flag("--no-nee", text.lacks_next_event_estimation, "Without next event estimation")->group("Rendering");
    app.add_option("--denoiser", text.denoiser, "svgf+, svgf or none")->group("Rendering")->capture_default_str();
    app.add_option("--holes", text.holes,
                   "How pixels are filled that the source does not show: all, none (path traced), or a list of "
                   "previous,isolated,cascade,source,denoise")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--alpha", settings.temporal_alpha, "Weight of a new frame in the history")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--exposure", text.exposure, "auto: log average, frozen after the first frame; or a factor")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--tone-map", text.tone_map, "srgb or aces")->group("Rendering")->capture_default_str();
    app.add_option("--seed", config.seed, "Of all random numbers")->group("Rendering")->capture_default_str();
    app.add_option("--traversal", config.traversal, "auto, bvh or rayquery")
        ->group("Rendering")
        ->check(CLI::IsMember({"auto", "bvh", "rayquery"}))
        ->capture_default_str();
    app.add_option("--device", config.device, "Part of a Vulkan device's name; default: the best")->group("Rendering");
    app.add_flag("--validation", config.has_validation, "Vulkan validation layer")->group("Rendering");
}

void add_serving_flags(CLI::App& app, FlagText& text, Config& config) {
    app.add_option("--listen", text.listen, "HOST:PORT, loopback only; port 0: any, with --port-file")
        ->group("Serving")
        ->capture_default_str();
    app.add_option("--port-file", text.port_file, "Gets the port number once the server is SERVING")->group("Serving");
    app.add_option("--view-quality", config.view_quality, "Of views in a lossy codec, 1 to 100, unless the client says")
        ->group("Serving")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    app.add_option("--max-sessions", config.limits.max_sessions, "Clients at the same time")
        ->group("Serving")
        ->capture_default_str();
    app.add_option("--max-sessions-per-peer", config.limits.max_sessions_per_peer, "Of one address")
        ->group("Serving")
        ->capture_default_str();
    app.add_option("--log-level", text.log_level, "debug, info, warn or error")
        ->group("Serving")
        ->capture_default_str();
}

/// What is set, or has a default, as a --config file. CLI11 writes what is unset as an empty text, which is no value.
std::string config_file(const CLI::App& app) {
    std::istringstream lines(app.config_to_str(true, false));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        text += line.ends_with("=\"\"") || line.empty() ? "" : line + '\n';
    }
    return text;
}

/// Parses; what CLI11 has to say, if that ends the program.
std::optional<Invocation> parse(CLI::App& app, int argc, const char* const* argv) {
    Invocation early;
    try {
        app.parse(argc, argv);
        return std::nullopt;
    } catch (const CLI::CallForHelp&) {
        early.text = app.help();
    } catch (const CLI::CallForVersion& version) {
        early.text = version.what() + std::string("\n");
    } catch (const CLI::ParseError& error) {
        early.problems.emplace_back(error.what());
    }
    early.kind = Invocation::Kind::kPrint;
    return early;
}

} // namespace

Invocation read_flags(int argc, const char* const* argv) {
    Invocation invocation;
    FlagText text;
    bool only_check = false;
    bool only_print = false;
    CLI::App app("Path traces light fields and streams them to many displays.", "fieldcast-server");
    app.footer(kExamples);
    app.set_config("--config", "", "TOML file with the flags' names");
    app.set_version_flag("--version", "fieldcast-server " FIELDCAST_VERSION);
    app.add_flag("--check-config", only_check, "Validate, report all problems, exit")->configurable(false);
    app.add_flag("--print-config", only_print, "Print what would be used, as a --config file, and exit")
        ->configurable(false);
    add_scene_flags(app, text, invocation.config);
    add_image_flags(app, text, invocation.config);
    add_render_flags(app, text, invocation.config);
    add_serving_flags(app, text, invocation.config);
    if (auto early = parse(app, argc, argv)) {
        return *early;
    }
    read_text(text, invocation.config, invocation.problems);
    if (invocation.problems.empty()) {
        invocation.problems = problems_of(invocation.config);
    }
    if (only_print) {
        invocation.kind = Invocation::Kind::kPrint;
        invocation.text = config_file(app);
    } else if (only_check) {
        invocation.kind = Invocation::Kind::kCheck;
    }
    return invocation;
}

} // namespace fieldcast::ops
