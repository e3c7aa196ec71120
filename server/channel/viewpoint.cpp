// SPDX-License-Identifier: Apache-2.0
#include "server/channel/viewpoint.h"

#include "core/base/error.h"
#include "core/base/log.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <numbers>

namespace fieldcast::channel {

namespace {

constexpr float kDefaultSpacing_m = 0.03F; ///< used if the camera sees no surface

float aspect_of(const Settings& settings) {
    return static_cast<float>(settings.width_px) / static_cast<float>(settings.height_px);
}

bool is_framed(const scene::Scene& scene, const Settings& settings) {
    const bool is_open = settings.camera.empty() && scene.cameras.empty();
    return is_open || settings.camera == scene::kFramingCamera || settings.framing.any();
}

void frame(scene::Scene& scene, const Settings& settings, const scene::RayProbe& probe, const std::string& name) {
    const scene::Framing framing = scene::find_framing(scene, probe, settings.framing, aspect_of(settings));
    const auto text = [](const glm::vec3& v) {
        char buffer[64];
        std::snprintf(buffer, sizeof buffer, "%.4g,%.4g,%.4g", static_cast<double>(v.x), static_cast<double>(v.y),
                      static_cast<double>(v.z));
        return std::string(buffer);
    };
    scene::add_camera(scene, framing, settings.framing.orbit_s);
    log::info("camera framed", {{"channel", name},
                                {"place", framing.is_inside ? "inside" : "outside"},
                                {"look_from", text(framing.from)},
                                {"look_at", text(framing.at)},
                                {"fov_deg", static_cast<double>(framing.fovy_rad) * 180.0 / std::numbers::pi}});
}

/// Finds a camera by name, or else by number.
std::optional<std::size_t> find_index(const scene::Scene& scene, const std::string& wanted) {
    if (const scene::CameraNode* const found = scene::find_camera(scene, wanted)) {
        return static_cast<std::size_t>(found - scene.cameras.data());
    }
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    const bool is_number = error == std::errc{} && end == wanted.data() + wanted.size() && number < scene.cameras.size();
    return is_number ? std::optional(number) : std::nullopt;
}

std::string camera_names(const scene::Scene& scene) {
    std::string names;
    for (std::size_t i = 0; i < scene.cameras.size() && i < 16; ++i) {
        names += std::to_string(i) + " '" + scene.cameras[i].name + "', ";
    }
    return names + "and 'auto', which is always there";
}

/// Settles spacing and convergence for the largest grid, unless flags or file give them.
void fit_lattice(const scene::Scene& scene, const Settings& settings, const scene::RayProbe& probe,
                 const std::string& name, Viewpoint& viewpoint) {
    const scene::CameraNode& camera = scene.cameras[viewpoint.camera];
    const auto start_ns = static_cast<std::int64_t>(settings.fixed_time_s.value_or(0.0) * 1e9);
    const glm::mat4 pose = scene::camera_pose(scene::pose_scene(scene, start_ns), camera);
    const auto depths = scene::depth_range(probe, pose, camera.fovy_rad, aspect_of(settings));
    if (!depths) {
        viewpoint.spacing_m = kDefaultSpacing_m;
        return;
    }
    if (!settings.has_convergence) {
        viewpoint.convergence_m = depths->middle_m;
    }
    const std::uint32_t count = std::max({settings.largest_grid.rows, settings.largest_grid.cols, 2U});
    viewpoint.spacing_m =
        scene::comfortable_spacing(*depths, viewpoint.convergence_m, count, camera.fovy_rad, aspect_of(settings));
    log::info("views fitted to the scene",
              {{"channel", name},
               {"spacing_m", static_cast<double>(viewpoint.spacing_m)},
               {"convergence_m", static_cast<double>(viewpoint.convergence_m)},
               {"nearest_m", static_cast<double>(depths->near_m)},
               {"farthest_m", static_cast<double>(depths->far_m)},
               {"largest_disparity_percent", static_cast<double>(scene::kComfortableDisparity) * 100.0}});
}

} // namespace

Viewpoint settle_viewpoint(scene::Scene& scene, const Settings& settings, const std::string& name) {
    std::optional<scene::RayProbe> probe; // costs time and memory, so it is made only if needed
    const auto rays = [&]() -> const scene::RayProbe& {
        return probe ? *probe : probe.emplace(scene, scene::pose_scene(scene, 0));
    };
    Viewpoint viewpoint{.convergence_m = settings.lattice.convergence_m};
    if (is_framed(scene, settings)) {
        frame(scene, settings, rays(), name);
        viewpoint.camera = scene.cameras.size() - 1;
    } else if (const auto index = find_index(scene, settings.camera)) {
        viewpoint.camera = *index;
    } else {
        throw UserError(scene.name + ": has no camera '" + settings.camera + "'; it has " + camera_names(scene));
    }
    const std::optional<float> said_m =
        settings.spacing_m ? settings.spacing_m : scene.cameras[viewpoint.camera].spacing_m;
    if (said_m) {
        viewpoint.spacing_m = *said_m;
    } else {
        fit_lattice(scene, settings, rays(), name, viewpoint);
    }
    return viewpoint;
}

} // namespace fieldcast::channel
