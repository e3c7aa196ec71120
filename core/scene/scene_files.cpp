// SPDX-License-Identifier: Apache-2.0
#include "core/scene/scene_files.h"

#include "core/scene/load_report.h"
#include "core/scene/studio.h"
#include "core/scene/uri.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace fieldcast::scene {

namespace fs = std::filesystem;

namespace {

/// Whether `file` lies in `folder`. Both paths must be canonical.
bool is_inside(const fs::path& folder, const fs::path& file) {
    const auto [folder_end, file_rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return folder_end == folder.end() && file_rest != file.end();
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
    return text;
}

} // namespace

SceneFileReader::SceneFileReader(const fs::path& file, std::uint64_t max_bytes) : bytes_left_(max_bytes) {
    files_.main = file.filename().string();
    std::error_code error;
    files_.folder = fs::canonical(file.has_parent_path() ? file.parent_path() : fs::path("."), error);
    if (error || files_.main.empty()) {
        refuse(file.string(), "file", "cannot open: " + (error ? error.message() : "not a file"));
    }
    if (const auto checked = check_relative_path(files_.main); !checked || *checked != files_.main) {
        refuse(file.string(), "file",
               checked ? "the file name cannot be used in a bundle; rename it" : checked.error().message);
    }
    add(files_.main, file, "file");
}

std::span<const std::byte> SceneFileReader::read_uri(const std::string& uri, const std::string& object) {
    const Decoded<std::string> path = path_of_uri(uri);
    if (!path) {
        refuse(files_.main, object, path.error().message);
    }
    if (const auto found = files_.bytes.find(*path); found != files_.bytes.end()) {
        return found->second;
    }
    std::error_code error;
    const fs::path file = fs::canonical(files_.folder / *path, error);
    if (error) {
        refuse(files_.main, object, "cannot open '" + *path + "': " + error.message());
    }
    if (!is_inside(files_.folder, file)) {
        refuse(files_.main, object, "'" + *path + "' leaves the scene's folder; put the file into it");
    }
    add(*path, file, object);
    return files_.bytes.at(*path);
}

void add_studio(SceneFiles& files) {
    files.environment = std::string(kEnvironmentStem) + std::string(kStudioExtension);
    files.bytes.insert_or_assign(files.environment, studio_file());
}

void SceneFileReader::read_environment(const fs::path& file) {
    files_.environment = std::string(kEnvironmentStem) + lower_case(file.extension().string());
    if (!check_relative_path(files_.environment) || files_.bytes.contains(files_.environment)) {
        refuse(file.filename().string(), "environment", "the file name cannot be used in a bundle; rename it");
    }
    add(files_.environment, file, "environment");
}

void SceneFileReader::add(const std::string& path, const fs::path& file, const std::string& object) {
    std::error_code error;
    // Pipes and devices would block or never end.
    const bool is_regular = fs::is_regular_file(file, error);
    const std::uint64_t size = is_regular ? fs::file_size(file, error) : 0;
    if (error || !is_regular) {
        refuse(files_.main, object, "cannot open '" + path + "': " + (error ? error.message() : "not a regular file"));
    }
    if (size > bytes_left_) {
        refuse(files_.main, object, "'" + path + "' exceeds the limit on the size of all files; use smaller files");
    }
    std::vector<std::byte> bytes(size);
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!stream) {
        refuse(files_.main, object, "cannot read '" + path + "'");
    }
    bytes_left_ -= size;
    files_.bytes.emplace(path, std::move(bytes));
}

} // namespace fieldcast::scene
