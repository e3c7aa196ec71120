// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/benchmark_scene.h"
#include "bench/quality/quality_row.h"

namespace fieldcast::bench {

struct GridsSettings {
    BenchmarkScene scene;
    Protocol protocol; ///< its views are ignored: all views of each grid are scored
    std::filesystem::path references;
    std::string preset;
    std::vector<ViewGrid> grids; ///< rows and columns
    float exposure = 0.0F;       ///< 0: the scene's
};

/// Renders several grids of one scene, interleaved, and scores all their views. Each grid has its own source, guard
/// band and hole cascade, as in a channel for that grid.
class GridsRun {
public:
    /// Throws UserError if the scene is not usable or the preset is unknown.
    GridsRun(const gpu::Device& device, const GridsSettings& settings);

    /// Makes missing references, then renders every frame. Throws Interrupted.
    void run();

    /// Results of run(): `grids`, a list; `ssim_lost` from the first to the last. Without provenance.
    nlohmann::ordered_json result() const;
    std::uint64_t invalid_samples() const;

private:
    /// A grid and its scores.
    struct Entry {
        ViewGrid grid;
        QualityRow row;
    };

    std::vector<PictureId> wanted_references() const;
    void score(Entry& entry, std::uint32_t frame);

    GridsSettings settings_;
    LightFieldScene scene_;
    References references_;
    float exposure_ = 1.0F;
    std::vector<Entry> entries_;
};

} // namespace fieldcast::bench
