// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldcast::bench {

/// A scene that benchmarks know by name: bench/scenes/NAME.json. Its exposure is fixed, so that numbers of all rows,
/// runs and machines are about the same picture.
struct BenchmarkScene {
    std::string title;          ///< as tables show it; of a file without a name: its path
    std::filesystem::path file; ///< glTF; relative paths start in the repository's root
    float exposure = 0.0F;      ///< multiplies linear radiance; 0: automatic, from the first frame
};

/// `name_or_file`: a name, or a glTF file, whose exposure is automatic. Throws UserError if a name is not known or its
/// description is malformed. `folder` holds the descriptions.
BenchmarkScene find_benchmark_scene(const std::string& name_or_file,
                                    const std::filesystem::path& folder = "bench/scenes");

/// Sorted; empty if there is no such folder.
std::vector<std::string> benchmark_scene_names(const std::filesystem::path& folder = "bench/scenes");

/// What `--scene` says in --help.
std::string describe_scene_option();

} // namespace fieldcast::bench
