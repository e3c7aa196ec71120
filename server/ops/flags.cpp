// SPDX-License-Identifier: Apache-2.0
#include "server/ops/flags.h"

#include "core/base/error.h"
#include "core/lightfield/presets.h"
#include "server/ops/camera_flags.h"
#include "server/ops/config_file.h"
#include "server/ops/flag_text.h"
#include "server/ops/health_flags.h"
#include "server/ops/job_flags.h"
#include "server/ops/limit_flags.h"
#include "server/ops/new_token.h"
#include "server/ops/recording_flags.h"
#include "server/ops/security_flags.h"
#include "server/ops/task.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace fieldcast::ops {

namespace {

constexpr const char* kExamples = R"(Examples:
  fieldcast-server --scene scenes/atelier/atelier.gltf
  fieldcast-server --scene hall.glb --environment noon.exr --size 640x360 --fps 15
  fieldcast-server --channel red=a.gltf --channel blue=b.gltf --listen 127.0.0.1:0 --port-file port.txt
  fieldcast-server --scene a.gltf --clock frames --frames 30 --seed 7        # the same 30 frames again and again
  fieldcast-server render --scene a.gltf --size 640x360 --count 60 --out field   # a light field in files
  fieldcast-server render --help                                                # what else it can write
  fieldcast-server record --scene a.gltf --size 640x360 --count 300 --out a.fcrec   # a channel in a file
  fieldcast-server inspect a.glb                                                # what is in a file
  fieldcast-server --replay a.fcrec                                             # and back, without a device
  fieldcast-server --make-token alice view
  fieldcast-server --health 127.0.0.1:50151            # exit code 0: SERVING
  fieldcast-server --scene a.gltf --tokens tokens.txt      # behind Envoy, see deploy/envoy.yaml

TERM or INT: drain, then stop. Again: stop at once. Exit codes: 0 ok, 1 the machine failed, 2 wrong input,
3 the port went deaf.)";

void add_scene_flags(CLI::App& app, FlagText& text, Config& config) {
    app.add_option("--scene", text.scenes, "A .gltf or .glb file; its channel is named after it. May be repeated")
        ->group("Scene");
    app.add_option("--channel", text.channels, "NAME=FILE: a channel of that name. May be repeated")->group("Scene");
    app.add_option("--environment", text.environment,
                   "Light from around, for all channels: an equirectangular .hdr or .exr, studio, sky (--sky) or none. "
                   "Default: the studio for files without any light, else the sky")
        ->group("Scene");
    app.add_option("--sky", text.sky, "R,G,B: linear radiance of the sky without an environment")->group("Scene");
    app.add_option("--camera", config.camera,
                   "Camera of the file, by name or number, or auto: frames the scene by itself. Default: LightField, else "
                   "the first, else auto")
        ->group("Scene");
    app.add_option("--look-from", text.look_from, "X,Y,Z: where the camera auto stands, metres")->group("Scene");
    app.add_option("--look-at", text.look_at, "X,Y,Z: what the camera auto looks at, metres")->group("Scene");
    app.add_option("--fov", text.fov_deg, "Vertical field of view of the camera auto, 1 to 170 degrees")->group("Scene");
    app.add_option("--orbit", config.framing.orbit_s,
                   "Seconds for one turn of the camera auto round what it looks at, from 0.1 on")
        ->group("Scene");
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
    app.add_option("--fps", config.frames_per_second, "Frames per second at most, 0.1 to 240")
        ->group("Light field")
        ->capture_default_str();
    app.add_option("--spacing", config.spacing_m,
                   "Distance of neighbouring views, metres; default: the camera's, else comfortable for the depths in sight")
        ->group("Light field");
    app.add_option("--convergence", text.convergence, "Depth of zero disparity, metres; inf: parallel cameras. Default: inf, or the subject's depth where the "
                   "spacing follows from depths, too")
        ->group("Light field");
    app.add_option("--largest-grid", text.largest_grid, "ROWSxCOLS that the guard band is made for")
        ->group("Light field")
        ->capture_default_str();
    app.add_option(
           "--sources", text.sources,
           "Path traced views: middle, top-left, diagonal, triangle, corners, or views of the largest grid as in "
           "\"0,0;5,5\"")
        ->group("Light field")
        ->capture_default_str();
    app.add_option("--guard-band", text.guard_band, "auto, none, or LEFT,RIGHT,TOP,BOTTOM in pixels")
        ->group("Light field")
        ->capture_default_str();
}

/// What happens to the light that was traced.
void add_filter_flags(CLI::App& app, FlagText& text, RenderSettings& settings) {
    app.add_option("--denoiser", text.denoiser, "svgf+, svgf, bmfr or none")->group("Rendering")->capture_default_str();
    app.add_option("--sampler", text.sampler,
                   "Random numbers: z-sobol (neighbouring pixels complement one another) or sobol (each on its own)")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--reflections", text.reflections,
                   "on: smooth surfaces show each view what they mirror there; off: their light sticks to them")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--holes", text.holes,
                   "How pixels are filled that the source does not show: all, none (path traced), or a list of "
                   "previous,isolated,cascade,source,denoise")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--denoise", text.denoise, "Images that are denoised: the source, or all views")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--accumulate-views", text.accumulate_views,
                   "on: every view averages its own light over frames as well, as in the paper; or off")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--alpha", settings.temporal_alpha, "Weight of a new frame in the history")
        ->group("Rendering")
        ->capture_default_str();
}

void add_render_flags(CLI::App& app, FlagText& text, Config& config) {
    RenderSettings& settings = config.settings;
    app.add_option("--preset", text.preset, "Where the defaults of the other flags come from: " + preset_names())
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--spp", settings.samples_per_pixel, "Samples per pixel")->group("Rendering")->capture_default_str();
    app.add_option("--bounces", settings.max_bounces, "Bounces at most")->group("Rendering")->capture_default_str();
    app.add_option("--light-candidates", settings.light_sampling.candidates,
                   "Candidates of which the best is taken as light sample")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--each-light-kind", text.each_light_kind,
                   "on: sky, emissive surfaces and lamps have a shadow ray each where a pixel looks, and shadows of "
                   "lamps and sun are filtered apart; off: one for all")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--history-light", text.history_light,
                   "on: paths end on surfaces that the frame before showed, with its light for them; or off")
        ->group("Rendering")
        ->capture_default_str();
    app.add_flag("--no-nee", text.lacks_next_event_estimation, "Without next event estimation")->group("Rendering");
    app.add_flag("--accumulate", settings.accumulate,
                 "While nothing moves, average frames without bias instead of denoising them")
        ->group("Rendering");
    add_filter_flags(app, text, settings);
    app.add_option("--exposure", text.exposure, "auto: log average, frozen after the first frame; or a factor")
        ->group("Rendering")
        ->capture_default_str();
    app.add_option("--tone-map", text.tone_map, "srgb or aces")->group("Rendering")->capture_default_str();
    app.add_option("--seed", config.seed, "Of all random numbers")->group("Rendering")->capture_default_str();
    app.add_option("--traversal", config.traversal, "auto, bvh or rayquery")
        ->group("Rendering")
        ->check(CLI::IsMember({"auto", "bvh", "rayquery"}))
        ->capture_default_str();
    app.add_option("--visibility", config.visibility,
                   "How it is found what views see: rays, raster, or auto: what is faster")
        ->group("Rendering")
        ->check(CLI::IsMember({"auto", "rays", "raster"}))
        ->capture_default_str();
    app.add_option("--device", config.device, "Part of a Vulkan device's name; default: the best")->group("Rendering");
    app.add_flag("--validation", config.has_validation, "Vulkan validation layer")->group("Rendering");
}

void add_serving_flags(CLI::App& app, FlagText& text, Config& config) {
    app.add_option("--listen", text.listen,
                   "HOST:PORT; beyond loopback only with TLS, tokens and gRPC 1.57; port 0: any, with --port-file")
        ->group("Serving")
        ->capture_default_str();
    app.add_option("--port-file", text.port_file, "Gets the port number once the server is SERVING")->group("Serving");
    app.add_option("--quality", config.lossy_quality, "Of planes in a lossy codec, 1 to 100, unless the client says")
        ->group("Serving")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    app.add_option("--metrics-listen", text.metrics_listen,
                   "HOST:PORT of /metrics for Prometheus; beyond loopback only with TLS and tokens")
        ->group("Serving");
    app.add_option("--metrics-port-file", text.metrics_port_file, "Gets the port number of /metrics")->group("Serving");
    app.add_option("--frame-log", text.frame_log,
                   "FILE.csv or .jsonl: a row per frame and client, from pose to display")
        ->group("Serving");
    app.add_option("--trace", text.trace, "FILE.json for ui.perfetto.dev: every frame of every channel and client")
        ->group("Serving");
    app.add_option("--log-format", text.log_format, "text, or json: one object per line")
        ->group("Serving")
        ->capture_default_str();
    app.add_option("--log-level", text.log_level, "debug, info, warn or error")
        ->group("Serving")
        ->capture_default_str();
}

void add_health_flags(CLI::App& app, HealthText& text) {
    const auto add = [&](const char* flag, std::string& value, const char* help) {
        app.add_option(flag, value, help)->group("Probing another server")->configurable(false);
    };
    add("--health", text.server,
        "HOST:PORT or https://HOST:PORT: exit with 0 if that server says SERVING, else with 1");
    add("--health-ca", text.ca, "PEM file: who may have signed its certificate; without it: the system's authorities");
    add("--health-name", text.name, "Name in its certificate, if it is not the dialled one");
    add("--health-token-file", text.token_file, "File with the token to show; without it: FIELDCAST_TOKEN");
}

/// Everything that can be typed, and where it goes.
struct CommandLine {
    CLI::App app{"Path traces light fields and streams them to many displays.", "fieldcast-server"};
    FlagText text;
    Config config;
    std::string config_file;
    bool only_check = false;
    bool only_print = false;
    std::vector<std::string> new_token;
    HealthText health;
    Task task = Task::kServe;
    OfflineJob job;
    RecordJob record_job;
    std::vector<std::string> products{"quilt", "views", "exr"};

    explicit CommandLine(Task asked = Task::kServe, const std::string& preset = "default") : task(asked) {
        text.preset = preset;
        apply_preset(text, config);
        app.footer(kExamples);
        app.allow_extras(); // so that all of them can be told
        app.set_version_flag("--version", "fieldcast-server " FIELDCAST_VERSION);
        app.add_option("--config", config_file, "TOML file with the flags' names; flags win")->configurable(false);
        app.add_flag("--check-config", only_check, "Validate, report all problems, exit")->configurable(false);
        app.add_flag("--print-config", only_print, "Print what would be used, as a --config file, and exit")
            ->configurable(false);
        app.add_option("--make-token", new_token, "NAME ROLE: print a new token and its line for --tokens, and exit")
            ->type_size(2)
            ->expected(1)
            ->configurable(false);
        add_scene_flags(app, text, config);
        add_camera_flags(app, text);
        add_image_flags(app, text, config);
        add_render_flags(app, text, config);
        add_serving_flags(app, text, config);
        add_recording_flags(app, text.recording, config);
        add_limit_flags(app, config);
        add_security_flags(app, text, config.security);
        add_health_flags(app, health);
        if (task == Task::kRender) {
            add_offline_flags(app, job, products);
        } else if (task == Task::kRecord) {
            add_record_flags(app, record_job);
        }
    }
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;
};

/// What is wrong with the form of `arguments`; values are not looked at.
std::vector<std::string> parse(CommandLine& line, std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end()); // as CLI11 wants them
    std::vector<std::string> problems;
    try {
        line.app.parse(arguments);
    } catch (const CLI::Success&) {
        throw; // --help, --version
    } catch (const CLI::ParseError& error) {
        problems.push_back(problem_text(error, line.app));
    }
    for (const std::string& extra : line.app.remaining(true)) {
        if (!extra.starts_with("-")) {
            problems.push_back(stray_word_problem(extra));
            continue;
        }
        const std::string nearest = nearest_flag(flag_name(extra), line.app);
        problems.push_back(extra + ": there is no such flag" +
                           (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
    }
    return problems;
}

/// Takes out of `file` what cannot be read, and says so.
void check_each(FileArguments& file) {
    std::erase_if(file.arguments, [&](const std::string& argument) {
        CommandLine alone;
        const std::vector<std::string> problems = parse(alone, {argument});
        for (const std::string& problem : problems) {
            const bool names_flag = problem.starts_with(flag_name(argument));
            file.problems.push_back(
                with_place(names_flag ? problem : flag_name(argument) + ": " + problem, file.places));
        }
        return !problems.empty();
    });
}

/// What the arguments ask for, together with those of a --config file.
Invocation read_all(const std::vector<std::string>& arguments, const CommandLine& typed) {
    FileArguments file;
    if (!typed.config_file.empty()) {
        file = read_config_file(typed.config_file, typed.app);
        if (!file.is_parsed) {
            Invocation refused; // with no further problems: what seems to be missing may stand in it
            refused.problems = file.problems;
            return refused;
        }
        check_each(file);
    }
    std::vector<std::string> merged(file.arguments);
    merged.insert(merged.end(), arguments.begin(), arguments.end());
    CommandLine first(typed.task);
    parse(first, merged); // for the preset; problems are told below
    CommandLine all(typed.task, first.text.preset);
    Invocation invocation;
    std::vector<std::string> problems = parse(all, merged);
    read_text(all.text, all.config, problems);
    if (all.task == Task::kRecord && (all.config.channels.size() != 1 || !all.config.replays.empty())) {
        problems.emplace_back("--scene: record takes exactly one scene, and no recordings");
    }
    if (all.task == Task::kRender && !all.config.replays.empty()) {
        problems.emplace_back("--replay: render takes scenes, no recordings");
    }
    const std::vector<std::string> further = problems_of(all.config);
    problems.insert(problems.end(), further.begin(), further.end());
    invocation.problems = file.problems;
    for (const std::string& problem : problems) {
        invocation.problems.push_back(with_place(problem, file.places));
    }
    if (all.only_print) {
        invocation.kind = Invocation::Kind::kPrint;
        invocation.text = invocation.problems.empty() ? config_text(all.app) : "";
    } else if (all.only_check) {
        invocation.kind = Invocation::Kind::kCheck;
    } else if (all.task == Task::kRecord) {
        invocation.kind = Invocation::Kind::kRecord;
        invocation.record_job = std::move(all.record_job);
    } else if (all.task == Task::kRender) {
        invocation.kind = Invocation::Kind::kRender;
        invocation.job = std::move(all.job);
        invocation.job.products = read_products(all.products);
    }
    invocation.config = std::move(all.config);
    return invocation;
}

Invocation read(const std::vector<std::string>& arguments, CommandLine& typed) {
    Invocation early;
    early.kind = Invocation::Kind::kPrint;
    try {
        early.problems = parse(typed, arguments);
        if (early.problems.empty() && !typed.new_token.empty()) {
            early.text = new_token_text(typed.new_token.at(0), typed.new_token.at(1));
            return early;
        }
        if (early.problems.empty() && !typed.health.server.empty()) {
            early.kind = Invocation::Kind::kHealth;
            early.health = read_health(typed.health, typed.text.tls_cert, typed.text.tls_key);
            return early;
        }
    } catch (const CLI::CallForVersion& version) {
        early.text = version.what() + std::string("\n");
        return early;
    } catch (const CLI::Success&) {
        early.text = typed.app.help();
        return early;
    } catch (const UserError& problem) {
        early.problems.emplace_back(problem.what());
    }
    return early.problems.empty() ? read_all(arguments, typed) : early;
}

} // namespace

Invocation read_flags(int argc, const char* const* argv) {
    const Task task = argc > 1 ? task_of(argv[1]) : Task::kServe;
    const std::vector<std::string> arguments{argv + (task == Task::kServe ? 1 : 2), argv + argc};
    if (task == Task::kInspect) {
        InspectInvocation asked = read_inspect(arguments);
        const auto kind = asked.text.empty() ? Invocation::Kind::kInspect : Invocation::Kind::kPrint;
        Invocation invocation;
        invocation.kind = kind;
        invocation.inspect_job = std::move(asked.job);
        invocation.problems = std::move(asked.problems);
        invocation.text = std::move(asked.text);
        return invocation;
    }
    CommandLine typed(task);
    return read(arguments, typed);
}

} // namespace fieldcast::ops
