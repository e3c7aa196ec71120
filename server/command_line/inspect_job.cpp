// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/inspect_job.h"

#include "core/base/printable.h"
#include "core/scene/framing.h"
#include "core/scene/gltf/extensions.h"
#include "core/scene/gltf/loader.h"
#include "server/command_line/config_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

namespace fieldcast::command_line {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExamples = R"(
Examples:
  fieldcast-server inspect helmet.glb
  fieldcast-server inspect helmet.glb --json | jq .triangles_shown

Exit codes: 0 the file opens, 2 it does not, and the reason is told.)";

Json json_of(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

template <class Element> std::uint64_t bytes_of(const std::vector<Element>& elements) {
    return elements.size() * sizeof(Element);
}

/// Of what is kept of the scene in memory, by the process that serves it.
std::uint64_t memory_of(const scene::Scene& scene) {
    std::uint64_t bytes = bytes_of(scene.environment.pixels) + bytes_of(scene.nodes) + bytes_of(scene.instances);
    for (const scene::Mesh& mesh : scene.meshes) {
        bytes += bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.tangents) + bytes_of(mesh.uv0) +
                 bytes_of(mesh.uv1) + bytes_of(mesh.colours) + bytes_of(mesh.triangles);
    }
    for (const scene::Image& image : scene.images) {
        bytes += image.rgba.size();
    }
    return bytes;
}

const char* word_of(scene::AlphaMode mode) {
    switch (mode) {
    case scene::AlphaMode::kOpaque:
        return "opaque";
    case scene::AlphaMode::kMask:
        return "mask";
    case scene::AlphaMode::kBlend:
        return "blend";
    }
    return "";
}

const char* word_of(scene::LightType type) {
    switch (type) {
    case scene::LightType::kDirectional:
        return "directional";
    case scene::LightType::kPoint:
        return "point";
    case scene::LightType::kSpot:
        return "spot";
    }
    return "";
}

/// How many there are of each word.
template <class Elements, class Member> Json counts_of(const Elements& elements, Member member) {
    Json counts = Json::object();
    for (const auto& element : elements) {
        const char* const word = word_of(element.*member);
        counts[word] = counts.value(word, 0) + 1;
    }
    return counts;
}

Json triangles_of(const scene::Scene& scene) {
    std::uint64_t own = 0;
    std::uint64_t shown = 0;
    for (const scene::Mesh& mesh : scene.meshes) {
        own += mesh.triangles.size();
    }
    for (const scene::Instance& instance : scene.instances) {
        shown += scene.meshes[instance.mesh].triangles.size();
    }
    return {{"triangles", own}, {"triangles_shown", shown}};
}

Json images_of(const scene::Scene& scene) {
    Json images = Json::array();
    for (const scene::Image& image : scene.images) {
        images.push_back({{"name", image.name}, {"width_px", image.width_px}, {"height_px", image.height_px}});
    }
    return images;
}

Json cameras_of(const scene::Scene& scene) {
    Json cameras = Json::array();
    for (const scene::CameraNode& camera : scene.cameras) {
        Json entry{{"number", cameras.size()},
                   {"name", camera.name},
                   {"fov_deg", camera.fovy_rad * 180.0F / std::numbers::pi_v<float>},
                   {"is_animated", scene.nodes[camera.node].is_animated}};
        if (camera.spacing_m) {
            entry["spacing_m"] = *camera.spacing_m;
        }
        cameras.push_back(std::move(entry));
    }
    return cameras;
}

Json extensions_of(const std::filesystem::path& file) {
    Json extensions = Json::array();
    for (const scene::ExtensionUse& use : scene::read_extensions(file)) {
        extensions.push_back({{"name", use.name}, {"is_required", use.is_required}, {"is_read", use.is_read}});
    }
    return extensions;
}

/// How `--camera auto` would see it, at 16:9.
Json framing_of(const scene::Scene& scene) {
    const scene::RayProbe probe(scene, scene::pose_scene(scene, 0));
    const scene::Framing framing = scene::find_framing(scene, probe, {}, 16.0F / 9.0F);
    return {{"place", framing.is_inside ? "inside" : "outside"},
            {"look_from", json_of(framing.from)},
            {"look_at", json_of(framing.at)},
            {"fov_deg", framing.fovy_rad * 180.0F / std::numbers::pi_v<float>}};
}

Json report_of(const std::filesystem::path& file) {
    const scene::LoadOptions options{
        .environment = {}, .surroundings = scene::Surroundings::kStudioIfUnlit, .limits = {}};
    const scene::Scene scene = scene::load_scene(file, options);
    const auto [low, high] = scene::extent_of(scene);
    Json report{{"file", file.string()}};
    report.update(triangles_of(scene));
    report["meshes"] = scene.meshes.size();
    report["instances"] = scene.instances.size();
    report["extent_m"] = {{"low", json_of(low)}, {"high", json_of(high)}, {"size", json_of(high - low)}};
    report["materials"] = counts_of(scene.materials, &scene::Material::alpha_mode);
    report["images"] = images_of(scene);
    report["lights"] = counts_of(scene.lights, &scene::Light::type);
    report["environment"] = scene.has_studio ? "studio" : "sky";
    report["cameras"] = cameras_of(scene);
    report["camera_auto"] = framing_of(scene);
    report["animation_channels"] = scene.channels.size();
    report["animation_s"] = scene.duration_s;
    report["extensions"] = extensions_of(file);
    report["memory_bytes"] = memory_of(scene);
    report["warnings"] = scene.warnings;
    return report;
}

std::string counted(const Json& counts) {
    std::string text;
    for (const auto& [word, count] : counts.items()) {
        text += (text.empty() ? "" : ", ") + std::to_string(count.get<int>()) + " " + word;
    }
    return text.empty() ? "none" : text;
}

std::string point_text(const Json& point) {
    std::ostringstream text;
    text.precision(4);
    text << point[0].get<float>() << ", " << point[1].get<float>() << ", " << point[2].get<float>();
    return text.str();
}

/// Writes a line per element, up to a largest number of lines.
void write_some(std::ostringstream& text, const Json& entries, const std::function<std::string(const Json&)>& line) {
    constexpr std::size_t kMost = 12;
    for (std::size_t i = 0; i < std::min(kMost, entries.size()); ++i) {
        text << "                " << printable(line(entries[i])) << '\n'; // names come from the file
    }
    if (entries.size() > kMost) {
        text << "                and " << entries.size() - kMost << " more (--json has all)\n";
    }
}

std::string camera_text(const Json& camera) {
    return std::to_string(camera["number"].get<int>()) + " " + camera["name"].get<std::string>() +
           (camera["is_animated"].get<bool>() ? ", moves" : "");
}

std::string text_of(const Json& report) {
    std::ostringstream text;
    text << report["file"].get<std::string>() << "\n\n";
    text << "  triangles     " << report["triangles"] << " in " << report["meshes"] << " meshes; shown "
         << report["triangles_shown"] << " in " << report["instances"] << " instances\n";
    text << "  size          " << point_text(report["extent_m"]["size"]) << " m\n";
    text << "  materials     " << counted(report["materials"]) << '\n';
    text << "  images        " << report["images"].size() << '\n';
    write_some(text, report["images"], [](const Json& image) {
        return image["name"].get<std::string>() + ", " + std::to_string(image["width_px"].get<int>()) + "x" +
               std::to_string(image["height_px"].get<int>());
    });
    text << "  lights        " << counted(report["lights"]) << "; environment "
         << report["environment"].get<std::string>() << '\n';
    text << "  cameras       " << report["cameras"].size() << '\n';
    write_some(text, report["cameras"], camera_text);
    text << "  camera auto   " << report["camera_auto"]["place"].get<std::string>() << ", from "
         << point_text(report["camera_auto"]["look_from"]) << " to " << point_text(report["camera_auto"]["look_at"])
         << '\n';
    text << "  animation     " << report["animation_channels"] << " channels, " << report["animation_s"] << " s\n";
    text << "  extensions    " << report["extensions"].size() << '\n';
    write_some(text, report["extensions"], [](const Json& use) {
        return use["name"].get<std::string>() + (use["is_read"].get<bool>() ? ", read" : ", left out") +
               (use["is_required"].get<bool>() ? ", required" : "");
    });
    text << "  memory        " << (report["memory_bytes"].get<std::uint64_t>() >> 10U)
         << " KiB in the process, without the device's\n";
    text << "  warnings      " << report["warnings"].size() << '\n';
    write_some(text, report["warnings"], [](const Json& warning) { return warning.get<std::string>(); });
    return text.str();
}

} // namespace

std::string inspect(const InspectJob& job) {
    const Json report = report_of(job.file);
    return job.as_json ? report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : text_of(report);
}

std::string camera_list(const std::filesystem::path& file) {
    const Json cameras = cameras_of(scene::load_scene(file, scene::LoadOptions{}));
    std::ostringstream text;
    text << printable(file.string()) << (cameras.empty() ? ": no camera; --camera auto frames the scene\n" : ":\n");
    for (const Json& camera : cameras) {
        text << "  " << printable(camera_text(camera)) << ", " << std::lround(camera["fov_deg"].get<double>()) << "°\n";
    }
    return text.str();
}

InspectInvocation read_inspect(std::vector<std::string> arguments) {
    InspectInvocation invocation;
    CLI::App app{"Tells what is in a glTF file, and how it would be shown.", "fieldcast-server inspect"};
    app.footer(kExamples);
    app.add_option("file", invocation.job.file, "A .gltf or .glb file");
    app.add_flag("--json", invocation.job.as_json, "As one JSON object");
    std::reverse(arguments.begin(), arguments.end()); // as CLI11 wants them
    try {
        app.parse(arguments);
        if (invocation.job.file.empty()) {
            invocation.problems.emplace_back("inspect: name a file, as in 'fieldcast-server inspect helmet.glb'");
        }
    } catch (const CLI::Success&) {
        invocation.text = app.help();
    } catch (const CLI::ParseError& error) {
        invocation.problems.push_back(problem_text(error, app));
    }
    return invocation;
}

} // namespace fieldcast::command_line
