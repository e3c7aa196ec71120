// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/scene_flags.h"

#include "server/command_line/typed_text.h"
#include "server/command_line/word_flags.h"

#include <array>
#include <numbers>

namespace fieldcast::command_line {

namespace {

using Problems = std::vector<std::string>;

constexpr std::array kClocks{Word{.word = "real", .value = channel::ClockMode::kReal},
                             Word{.word = "frames", .value = channel::ClockMode::kFrames}};

void read_channels(const SceneText& text, channel::Settings& rendering, Problems& problems) {
    for (const std::string& scene : text.scenes) {
        const std::filesystem::path file(scene);
        rendering.channels.push_back({.name = file.stem().string(), .scene = file});
    }
    for (const std::string& channel : text.channels) {
        const std::size_t equals = channel.find('=');
        if (equals == std::string::npos) {
            problems.push_back("--channel " + channel + ": write NAME=FILE");
            continue;
        }
        rendering.channels.push_back({.name = channel.substr(0, equals), .scene = channel.substr(equals + 1)});
    }
}

void read_sky(const SceneText& text, channel::Settings& rendering, Problems& problems) {
    std::array<float, 3> sky{};
    if (text.sky.empty()) {
        return;
    }
    if (!read_list<float>(text.sky, sky)) {
        problems.push_back("--sky " + text.sky + ": write R,G,B, as in 0.5,0.7,1");
        return;
    }
    rendering.sky = glm::vec3(sky[0], sky[1], sky[2]);
}

/// After read_sky().
void read_environment(const SceneText& text, channel::Settings& rendering) {
    if (text.environment == "studio") {
        rendering.surroundings = scene::Surroundings::kStudio;
    } else if (text.environment == "sky" || text.environment == "none" || (text.environment.empty() && rendering.sky)) {
        rendering.surroundings = scene::Surroundings::kSky;
    } else if (!text.environment.empty()) {
        rendering.environment = text.environment;
    }
    if (text.environment == "none") {
        rendering.sky = glm::vec3(0.0F);
    }
}

std::optional<glm::vec3> read_point(const char* flag, const std::string& text, Problems& problems) {
    std::array<float, 3> point{};
    if (text.empty()) {
        return std::nullopt;
    }
    if (!read_list<float>(text, point)) {
        problems.push_back(std::string(flag) + " " + text + ": write X,Y,Z in metres, as in 0,1.6,4");
        return std::nullopt;
    }
    return glm::vec3(point[0], point[1], point[2]);
}

} // namespace

void add_scene_flags(CLI::App& app, WordFlags& words, SceneText& text, channel::Settings& rendering) {
    const auto add = [&](const char* flag, auto& value, const char* help) {
        app.add_option(flag, value, help)->group("Scene");
    };
    add("--scene", text.scenes, "A .gltf or .glb file; its channel gets the file's name. Repeatable.");
    add("--channel", text.channels, "NAME=FILE: a scene whose channel gets this name. Repeatable.");
    add("--environment", text.environment,
        "Light from around all scenes: an equirectangular .hdr or .exr file, studio, sky (see --sky) or none. Default: "
        "studio for files without any light, else sky.");
    add("--sky", text.sky, "R,G,B: linear radiance of the sky without an environment.");
    add("--camera", rendering.camera,
        "Camera of the file, by name or number, or auto, which frames the scene. Default: LightField, else the first, "
        "else auto.");
    add("--look-from", text.look_from, "X,Y,Z: position of the camera auto, metres.");
    add("--look-at", text.look_at, "X,Y,Z: point at which the camera auto looks, metres.");
    add("--fov", text.fov_deg, "Vertical field of view of the camera auto, 1 to 170 degrees.");
    add("--orbit", rendering.framing.orbit_s,
        "Seconds in which the camera auto circles the point at which it looks, at least 0.1.");
    app.add_flag("--fixed-camera", rendering.has_fixed_camera, "Keep the camera where it is at the start.")
        ->group("Scene");
    add("--time", rendering.fixed_time_s, "Freeze the scene at this time, seconds.");
    words
        .add("--clock", rendering.clock, kClocks, "Scene time: real (wall clock) or frames (1/fps per rendered frame).")
        ->group("Scene");
    app.add_option("--frames", rendering.loop_frames,
                   "With --clock frames: number of frames after which the scene starts again; 0: never.")
        ->group("Scene")
        ->capture_default_str();
}

void read_scenes(const SceneText& text, channel::Settings& rendering, Problems& problems) {
    read_channels(text, rendering, problems);
    read_sky(text, rendering, problems);
    read_environment(text, rendering);
    rendering.framing.look_from = read_point("--look-from", text.look_from, problems);
    rendering.framing.look_at = read_point("--look-at", text.look_at, problems);
    if (text.fov_deg) {
        rendering.framing.fovy_rad = *text.fov_deg * std::numbers::pi_v<float> / 180.0F;
    }
}

} // namespace fieldcast::command_line
