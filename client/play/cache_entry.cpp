// SPDX-License-Identifier: Apache-2.0
#include "client/play/cache_entry.h"

#include "core/image/atomic_file.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

namespace fieldcast::client::play {
namespace {

constexpr const char* kEntryName = "entry.json";

/// The file `text` below `folder`, or nothing if the path is absolute or leaves the folder.
std::optional<std::filesystem::path> inside(const std::filesystem::path& folder, const std::string& text) {
    const std::filesystem::path path(text);
    const bool climbs = std::find(path.begin(), path.end(), "..") != path.end();
    if (text.empty() || path.is_absolute() || climbs) {
        return std::nullopt;
    }
    return folder / path;
}

} // namespace

void write_cache_entry(const std::filesystem::path& folder, const scene::UnpackedBundle& unpacked) {
    nlohmann::json entry;
    entry["file"] = unpacked.file.lexically_relative(folder).generic_string();
    if (unpacked.options.environment) {
        entry["environment"] = unpacked.options.environment->lexically_relative(folder).generic_string();
    }
    const glm::vec3 sky = unpacked.options.sky;
    entry["sky"] = {sky.x, sky.y, sky.z};
    const std::string text = entry.dump(2) + "\n";
    image::write_file_atomically(folder / kEntryName, std::as_bytes(std::span(text)));
}

std::optional<scene::UnpackedBundle> read_cache_entry(const std::filesystem::path& folder) {
    std::ifstream file(folder / kEntryName);
    const nlohmann::json entry = nlohmann::json::parse(file, nullptr, false);
    if (!entry.is_object() || !entry.contains("file") || !entry["file"].is_string()) {
        return std::nullopt;
    }
    const auto scene_file = inside(folder, entry["file"].get<std::string>());
    const nlohmann::json sky = entry.value("sky", nlohmann::json());
    const bool has_sky = sky.is_array() && sky.size() == 3 &&
                         std::all_of(sky.begin(), sky.end(), [](const nlohmann::json& v) { return v.is_number(); });
    if (!scene_file || !has_sky) {
        return std::nullopt;
    }
    scene::UnpackedBundle unpacked;
    unpacked.file = *scene_file;
    unpacked.options.sky = {sky[0].get<float>(), sky[1].get<float>(), sky[2].get<float>()};
    if (entry.contains("environment") && entry["environment"].is_string()) {
        unpacked.options.environment = inside(folder, entry["environment"].get<std::string>());
        if (!unpacked.options.environment) {
            return std::nullopt;
        }
    }
    return unpacked;
}

} // namespace fieldcast::client::play
