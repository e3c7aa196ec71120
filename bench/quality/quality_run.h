// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/benchmark_scene.h"
#include "bench/pages/quality_page.h"
#include "bench/quality/quality_row.h"

namespace fieldcast::bench {

struct QualitySettings {
    BenchmarkScene scene;
    Protocol protocol;
    std::filesystem::path references;
    std::vector<std::string> presets; ///< rows besides 1 spp
    float exposure = 0.0F;            ///< 0: the scene's
    float indirect_clamp = -1.0F;     ///< < 0: the presets'
    bool renders_scored_views_only = false;
    bool has_temporal = false;
    bool has_light_field = false; ///< of the last scored frame; excludes renders_scored_views_only
    std::filesystem::path out;    ///< folder for scored views; empty: none
};

/// Renders all rows of a quality table, interleaved, and scores them.
class QualityRun {
public:
    /// Throws UserError if the scene is not usable or a preset is unknown.
    QualityRun(const gpu::Device& device, const QualitySettings& settings);

    /// Makes missing references, then renders every frame. Throws Interrupted.
    void run();

    /// Results of run(): exposure, rows by name, pictures. Without provenance.
    nlohmann::ordered_json result() const;

    /// The last view of the protocol in its last frame, made by every row, and its reference.
    const ShownPictures& shown() const { return shown_; }
    std::uint64_t invalid_samples() const;

private:
    void add_rows(const gpu::Device& device);
    std::vector<PictureId> wanted_references() const;
    void take_frame(std::uint32_t frame);
    void score_frame(std::uint32_t frame);
    void score_light_field();
    void keep(const std::string& name, const PictureId& id, const image::RgbF32& linear);
    const ViewMaker* find_reusing() const; ///< null: no row reuses
    std::uint32_t last_frame() const { return settings_.protocol.frames.back(); }

    QualitySettings settings_;
    LightFieldScene scene_;
    References references_;
    GroundTruth truth_;
    float exposure_ = 1.0F;
    std::vector<QualityRow> rows_;
    ShownPictures shown_;
};

} // namespace fieldcast::bench
