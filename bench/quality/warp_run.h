// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/coded_plane.h"
#include "bench/light_field_run.h"
#include "core/render/warp/warp_planes.h"

#include <filesystem>

namespace fieldcast::bench {

/// Settings of `warp`.
struct WarpSettings {
    std::vector<std::uint32_t> qualities{75, 90};
    std::uint32_t frames = 2; ///< rendered; the last one is measured
    float exposure = 0.0F;    ///< 0: automatic
    std::filesystem::path out{}; ///< folder for pictures; empty: none
};

/// Makes views from colour and depth of one frame and compares them with the views that the server makes.
class WarpRun {
public:
    WarpRun(const gpu::Device& device, LightFieldScene& scene, const WarpSettings& settings);

    /// Throws Interrupted.
    void run();

    /// source_size, guard_band_share, view_count, inverse_depth_unit, tiles, plane_bytes (each plane, lossless) and
    /// `rows`: mode, coding, bytes (of all views of the grid, or of all planes), ssim and rmse (mean over the views
    /// made, against the finished ones), worst_ssim, residual_percent, extended_percent (of the pixels of the views
    /// made), ms_per_view. With a folder for pictures also `pictures`: file, reference (both without ".png"), input
    /// (mode and coding), rmse and ssim.
    nlohmann::ordered_json result() const { return result_; }

private:
    void measure();
    void measure_views(const Views& finished, const Coding& coding);
    void measure_scene(const SourceFrame& frame);
    void measure_warp(const SourceFrame& frame, const Views& finished, const Coding& coding);
    void add_row(nlohmann::ordered_json row, const Views& made, const Views& finished);
    void write_pictures(const std::string& stem, const Views& views) const;

    LightFieldScene& scene_;
    WarpSettings settings_;
    std::vector<LatticePosition> positions_; ///< positions of the views that are made
    LightFieldRun run_;
    render::GridRenderer grid_renderer_;
    render::WarpPlanesRenderer planes_;
    render::WarpRenderer warp_;
    nlohmann::ordered_json result_;
};

} // namespace fieldcast::bench
