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

/// Folder, inside a bundle, of the environment image: it may lie anywhere on the machine that makes the bundle.
inline constexpr std::string_view kEnvironmentStem = "environment.fieldcast/sky";

/// Every file a scene is made of, read once. Paths are relative to the scene's folder, '/' separated.
struct SceneFiles {
    std::filesystem::path folder;
    std::string main;                                    ///< path of the glTF file
    std::string environment;                             ///< path of the environment image; empty: constant sky
    std::map<std::string, std::vector<std::byte>> bytes; ///< sorted bytewise; addresses stay valid when moved

    std::span<const std::byte> main_bytes() const { return bytes.at(main); }
};

/// Hash of the bundle that these files make, without making it.
SceneHash hash_files(const SceneFiles& files, const LoadOptions& options);

/// Adds the studio (core/scene/studio.h) as the environment image; twice is once.
void add_studio(SceneFiles& files);

/// Reads files into a SceneFiles; refuses what leaves the folder or is larger than all files together may be.
class SceneFileReader {
public:
    /// Reads the glTF file itself. Throws UserError.
    SceneFileReader(const std::filesystem::path& file, std::uint64_t max_bytes);

    /// Reads the file behind a relative URI (once, however often it is named). `object` is used in messages.
    std::span<const std::byte> read_uri(const std::string& uri, const std::string& object);
    /// Reads the environment image, which may lie outside the folder.
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
