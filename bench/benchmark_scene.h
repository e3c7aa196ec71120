// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldcast::bench {

/// A scene with a name, defined in bench/scenes/NAME.json. Its exposure is fixed, so that results of all rows, runs and
/// machines refer to the same picture.
struct BenchmarkScene {
    std::string title;          ///< title in tables; the path if the scene has no name
    std::filesystem::path file; ///< glTF; relative paths start in the repository's root
    float exposure = 0.0F;      ///< multiplies linear radiance; 0: automatic, from the first frame
};

/// `name_or_file`: a name, or a glTF file, whose exposure is automatic. `folder` contains the descriptions. Throws
/// UserError if the name is unknown or its description is malformed.
BenchmarkScene find_benchmark_scene(const std::string& name_or_file,
                                    const std::filesystem::path& folder = "bench/scenes");

/// Names of all scenes, sorted; empty if there is no such folder.
std::vector<std::string> benchmark_scene_names(const std::filesystem::path& folder = "bench/scenes");

/// Help text of `--scene`.
std::string describe_scene_option();

} // namespace fieldcast::bench
