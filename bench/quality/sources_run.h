// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/benchmark_scene.h"
#include "bench/quality/quality_row.h"

namespace fieldcast::bench {

struct SourcesSettings {
    BenchmarkScene scene;
    Protocol protocol;
    std::filesystem::path references;
    std::string preset;
    std::vector<std::string> configurations; ///< texts for parse_sources()
    float exposure = 0.0F;                   ///< 0: the scene's
    bool scores_all_views = false;           ///< of the last frame, instead of the protocol's views
    std::filesystem::path out;               ///< folder of heat maps; empty: none
};

/// Renders all views of one scene from several configurations of source images, interleaved, and scores them.
class SourcesRun {
public:
    /// Throws UserError if the scene is not usable, or the preset or a configuration is unknown.
    SourcesRun(const gpu::Device& device, const SourcesSettings& settings);

    /// Makes missing references, then renders every frame. Throws Interrupted.
    void run();

    /// Results of run(): `sources`, a list; of each all views of the last frame. Without provenance.
    nlohmann::ordered_json result() const;

    /// Writes a PNG per configuration and measure: discards, and RMSE and SSIM if all views are scored. Each measure
    /// has one scale.
    void write_heat_maps(const nlohmann::ordered_json& result) const;

    std::uint64_t invalid_samples() const;

private:
    struct Entry {
        std::string name;
        std::vector<LatticePosition> positions;
        QualityRow row;
    };

    std::vector<LatticePosition> scored_views() const;
    nlohmann::ordered_json views_of(const Entry& entry) const;

    SourcesSettings settings_;
    LightFieldScene scene_;
    References references_;
    float exposure_ = 1.0F;
    std::vector<Entry> entries_;
};

} // namespace fieldcast::bench
