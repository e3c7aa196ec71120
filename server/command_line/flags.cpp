// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/flags.h"

#include "core/base/error.h"
#include "core/lightfield/presets.h"
#include "server/command_line/camera_flags.h"
#include "server/command_line/config_file.h"
#include "server/command_line/health_flags.h"
#include "server/command_line/job_flags.h"
#include "server/command_line/light_field_flags.h"
#include "server/command_line/limit_flags.h"
#include "server/command_line/new_token.h"
#include "server/command_line/recording_flags.h"
#include "server/command_line/render_flags.h"
#include "server/command_line/scene_flags.h"
#include "server/command_line/security_flags.h"
#include "server/command_line/serving_flags.h"
#include "server/command_line/task.h"
#include "server/command_line/word_flags.h"
#include "server/config/problems.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace fieldcast::command_line {

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

/// Everything that can be typed, and where it goes.
struct CommandLine {
    CLI::App app{"Path traces light fields and streams them to many displays.", "fieldcast-server"};
    config::Config config;
    WordFlags words{app};
    SceneText scene;
    CameraText camera;
    LightFieldText light_field;
    RenderText render;
    ServingText serving;
    RecordingText recording;
    SecurityText security;
    HealthText health;
    std::string config_file;
    bool only_check = false;
    bool only_print = false;
    bool only_list_cameras = false;
    std::vector<std::string> new_token;
    Task task = Task::kServe;
    channel::OfflineJob job;
    channel::RecordJob record_job;
    std::vector<std::string> products{"quilt", "views", "exr"};

    explicit CommandLine(Task asked = Task::kServe, const std::string& preset = "default") : task(asked) {
        use_preset(preset);
        app.footer(kExamples);
        app.allow_extras(); // so that all of them can be reported
        add_own_flags();
        add_scene_flags(app, words, scene, config.rendering);
        add_camera_flags(app, camera);
        add_light_field_flags(app, light_field, config.rendering);
        add_render_flags(app, words, render, config.rendering);
        add_serving_flags(app, words, serving, config);
        add_recording_flags(app, recording, config.rendering);
        add_limit_flags(app, config);
        add_security_flags(app, security, config.security);
        add_health_flags(app, health);
        if (task == Task::kRender) {
            add_offline_flags(app, job, products);
        } else if (task == Task::kRecord) {
            add_record_flags(app, record_job);
        }
    }
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// Fills `config` from what was typed; adds a line to `problems` for everything that cannot be read.
    void read(std::vector<std::string>& problems) {
        read_scenes(scene, config.rendering, problems);
        read_cameras(camera, config.rendering, problems);
        read_light_field(light_field, config.rendering, problems);
        read_rendering(render, config.rendering, problems);
        read_serving(serving, config, problems);
        read_security(security, config.security, problems);
        read_recordings(recording, config.rendering, problems);
        words.read(problems);
        config.rendering.own_cameras.max_cameras = config.limits.max_own_cameras;
    }

private:
    /// Sets the defaults of the flags, which are added afterwards.
    void use_preset(const std::string& name) {
        render.preset = name;
        const ViewGrid& grid = config.rendering.largest_grid;
        if (const auto preset = find_preset(name, grid.rows, grid.cols)) {
            config.rendering.render = preset->settings;
            render.holes = preset->settings.holes == HoleFilling::path_traced() ? "none" : "all";
            light_field.guard_band = preset->has_guard_band ? "auto" : "none";
            light_field.sources = preset->sources;
        }
    }

    /// Flags that stand for no setting.
    void add_own_flags() {
        app.set_version_flag("--version", "fieldcast-server " FIELDCAST_VERSION);
        const auto add = [](CLI::Option* option) { option->configurable(false); };
        add(app.add_option("--config", config_file, "TOML file with the names of flags; flags win."));
        add(app.add_flag("--check-config", only_check, "Validate, report all problems and exit."));
        add(app.add_flag("--print-config", only_print, "Print the resulting settings as a --config file and exit."));
        add(app.add_flag("--list-cameras", only_list_cameras, "Print the cameras of all scenes and exit."));
        add(app.add_option("--make-token", new_token,
                           "NAME ROLE: print a new token and its line for --tokens, and exit.")
                ->type_size(2)
                ->expected(1));
    }
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

std::string cameras_text(const channel::Settings& rendering) {
    std::string text;
    for (const channel::ChannelChoice& channel : rendering.channels) {
        text += camera_list(channel.scene);
    }
    return text;
}

/// Sets what the flags of `all` ask for; `invocation` has its problems already.
void set_task(Invocation& invocation, CommandLine& all) {
    if (all.only_print) {
        invocation.kind = Invocation::Kind::kPrint;
        invocation.text = invocation.problems.empty() ? config_text(all.app) : "";
    } else if (all.only_list_cameras) {
        invocation.kind = Invocation::Kind::kPrint;
        invocation.text = invocation.problems.empty() ? cameras_text(all.config.rendering) : "";
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
    CommandLine all(typed.task, first.render.preset);
    Invocation invocation;
    std::vector<std::string> problems = parse(all, merged);
    all.read(problems);
    if (all.task == Task::kRecord &&
        (all.config.rendering.channels.size() != 1 || !all.config.rendering.replays.empty())) {
        problems.emplace_back("--scene: record takes exactly one scene, and no recordings");
    }
    if (all.task == Task::kRender && !all.config.rendering.replays.empty()) {
        problems.emplace_back("--replay: render takes scenes, no recordings");
    }
    const std::vector<std::string> further = config::problems_of(all.config);
    problems.insert(problems.end(), further.begin(), further.end());
    invocation.problems = file.problems;
    for (const std::string& problem : problems) {
        invocation.problems.push_back(with_place(problem, file.places));
    }
    set_task(invocation, all);
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
            early.health = read_health(typed.health, typed.security.tls_cert, typed.security.tls_key);
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

} // namespace fieldcast::command_line
