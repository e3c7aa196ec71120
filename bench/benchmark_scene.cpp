// SPDX-License-Identifier: Apache-2.0
#include "bench/benchmark_scene.h"

#include "core/base/error.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace fieldcast::bench {

namespace {

using nlohmann::json;

/// Member `key` of a description. Throws UserError if `is_good` rejects it.
template <class IsGood>
const json& member(const std::filesystem::path& file, const json& description, const char* key, IsGood is_good,
                   const char* expected) {
    if (!description.contains(key) || !is_good(description[key])) {
        throw UserError(file.string() + ": " + key + ": expected " + expected);
    }
    return description[key];
}

BenchmarkScene read_description(const std::filesystem::path& file) {
    std::ifstream stream(file);
    const json description = json::parse(stream, nullptr, false);
    if (!description.is_object()) {
        throw UserError(file.string() + ": not a JSON object");
    }
    for (const auto& [key, value] : description.items()) {
        if (key != "title" && key != "file" && key != "exposure") {
            throw UserError(file.string() + ": " + key + ": expected title, file and exposure only");
        }
    }
    const auto is_text = [](const json& value) { return value.is_string() && !value.get<std::string>().empty(); };
    const auto is_positive = [](const json& value) { return value.is_number() && value.get<double>() > 0.0; };
    return {member(file, description, "title", is_text, "a text").get<std::string>(),
            member(file, description, "file", is_text, "a glTF file").get<std::string>(),
            member(file, description, "exposure", is_positive, "a positive number").get<float>()};
}

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text;
}

} // namespace

BenchmarkScene find_benchmark_scene(const std::string& name_or_file, const std::filesystem::path& folder) {
    const std::filesystem::path path(name_or_file);
    if (path.has_extension() || path.has_parent_path()) {
        return {name_or_file, path, 0.0F};
    }
    const std::filesystem::path description = folder / (name_or_file + ".json");
    if (!std::filesystem::exists(description)) {
        const std::string names = join(benchmark_scene_names(folder));
        throw UserError("--scene " + name_or_file + ": expected a glTF file or " +
                        (names.empty() ? "a name (run this in the repository's root to use names)" : names));
    }
    return read_description(description);
}

std::vector<std::string> benchmark_scene_names(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (entry.path().extension() == ".json") {
            names.push_back(entry.path().stem().string());
        }
    }
    std::ranges::sort(names);
    return names;
}

std::string describe_scene_option() {
    const std::string names = join(benchmark_scene_names());
    return "glTF file" + (names.empty() ? std::string(".") : ", or " + names + " (bench/scenes, fixed exposure).");
}

} // namespace fieldcast::bench
