// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/load_options.h"
#include "core/scene/scene.h"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldcast::scene {

/// Path, without extension, of the environment image in a bundle. On the machine that makes the bundle, the image may
/// lie anywhere.
inline constexpr std::string_view kEnvironmentStem = "environment.fieldcast/sky";

/// All files of a scene, each read once. Paths are relative to the scene's folder, '/' separated.
struct SceneFiles {
    std::filesystem::path folder;
    std::string main;                                    ///< path of the glTF file
    std::string environment;                             ///< path of the environment image; empty: constant sky
    std::map<std::string, std::vector<std::byte>> bytes; ///< by path, sorted bytewise; moving keeps addresses valid

    std::span<const std::byte> main_bytes() const { return bytes.at(main); }
};

/// Hash of the bundle of these files. The bundle is not stored.
SceneHash hash_files(const SceneFiles& files, const LoadOptions& options);

/// Adds the studio (core/scene/studio.h) as the environment image. A second call changes nothing.
void add_studio(SceneFiles& files);

/// Reads files into a SceneFiles. Refuses paths that leave the scene's folder, and files that exceed `max_bytes` in
/// total.
class SceneFileReader {
public:
    /// Reads the glTF file itself. `max_bytes`: limit for all files together. Throws UserError.
    SceneFileReader(const std::filesystem::path& file, std::uint64_t max_bytes);

    /// Reads the file of a relative URI; repeated calls return the same bytes. Messages name `object`. Throws
    /// UserError.
    std::span<const std::byte> read_uri(const std::string& uri, const std::string& object);
    /// Reads the environment image, which may lie outside the folder. Throws UserError.
    void read_environment(const std::filesystem::path& file);
    /// Adds the studio (core/scene/studio.h) as the environment image.
    void add_studio() { scene::add_studio(files_); }

    const SceneFiles& files() const { return files_; }
    SceneFiles take() { return std::move(files_); }

private:
    void add(const std::string& path, const std::filesystem::path& file, const std::string& object);

    SceneFiles files_;
    std::uint64_t bytes_left_;
};

} // namespace fieldcast::scene
