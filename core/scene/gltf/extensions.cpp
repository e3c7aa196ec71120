// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/extensions.h"

#include "core/scene/gltf/json.h"
#include "core/scene/scene_files.h"

#include <algorithm>

namespace fieldcast::scene {

std::vector<ExtensionUse> read_extensions(const std::filesystem::path& file, const SceneLimits& limits) {
    const SceneFiles files = SceneFileReader(file, limits.max_file_bytes).take();
    const nlohmann::json root = parse_gltf_json(files.main_bytes(), files.main).root;
    const nlohmann::json required = root.value("extensionsRequired", nlohmann::json::array());
    std::vector<ExtensionUse> uses;
    for (const nlohmann::json& entry : root.value("extensionsUsed", nlohmann::json::array())) {
        const auto name = entry.get<std::string>();
        uses.push_back({.name = name,
                        .is_required = std::ranges::find(required, entry) != required.end(),
                        .is_read = is_supported_extension(name)});
    }
    return uses;
}

} // namespace fieldcast::scene
