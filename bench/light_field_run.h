// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/benchmark_scene.h"
#include "bench/measure.h"
#include "core/render/setup.h"
#include "core/render/source/source_renderer.h"
#include "core/scene/gltf/loader.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace fieldcast::bench {

/// A scene for benchmarks with its camera, a lattice of views and a moment in time.
class LightFieldScene {
public:
    struct Options {
        std::filesystem::path file;
        std::string environment{}; ///< empty: the scene's own
        std::string grid = "6x6";
        double spacing_m = 0.0; ///< 0: the camera's, else 0.03
        std::string traversal = "auto";
        std::string visibility = "auto"; ///< as in scene::choose_visibility
        Size size{};
    };

    /// Throws UserError if the scene has no camera or the grid is not valid.
    LightFieldScene(const gpu::Device& device, const Options& options);

    /// Poses the scene for frame `frame` at 30 frames per second; frame 0 is a cut.
    void pose(std::uint32_t frame);
    static std::int64_t time_of_frame_ns(std::uint32_t frame);

    /// Changes the number of views of `grid()`; the lattice stays the same.
    void choose_grid(std::uint32_t rows, std::uint32_t cols);

    Camera source() const; ///< in the current pose
    Camera view(LatticePosition position) const;
    render::ViewRequest request(std::vector<LatticePosition> positions) const;
    const ViewGrid& grid() const { return grid_; }
    const Size& size() const { return size_; }
    const scene::Scene& scene() const { return scene_; }
    scene::GpuScene& gpu_scene() { return gpu_scene_; }
    const scene::GpuScene& gpu_scene() const { return gpu_scene_; }

private:
    Size size_;
    scene::Scene scene_;
    const scene::CameraNode* camera_;
    scene::GpuScene gpu_scene_;
    ViewGrid grid_;
};

/// Renders the frames of a scene one after the other with one set of settings.
class LightFieldRun {
public:
    /// `settings.exposure` 0: automatic, from the first frame. Renders that frame in this case and if `has_guard_band`.
    LightFieldRun(const gpu::Device& device, LightFieldScene& scene, const RenderSettings& settings,
                  bool has_guard_band, std::vector<LatticePosition> source_positions = middle_source());

    /// Renders frame number `frame` with the current pose of the scene. Stage times are in the header of the result.
    Views render(std::uint32_t frame, const std::vector<LatticePosition>& positions);

    const render::SourcePlanes& source() const { return *source_; } ///< of the last render()
    Plane total_light() { return source_renderer_.total_light(); } ///< of the last render()
    const render::GridRenderer& grid_renderer() const { return grid_renderer_; }
    const FrameHeader& header() const { return header_; }
    const GuardBandChoice& guard_band() const { return guard_band_; }
    std::uint64_t invalid_samples() const {
        return source_renderer_.invalid_sample_count() + grid_renderer_.invalid_sample_count();
    }

private:
    LightFieldScene& scene_;
    render::SourceRenderer source_renderer_;
    render::GridRenderer grid_renderer_;
    FrameHeader header_;
    GuardBandChoice guard_band_;
    const render::SourcePlanes* source_ = nullptr;
};

/// The exposure: `wanted` if it is > 0, else that of the benchmark scene, else automatic, for which it renders a frame.
float choose_exposure(const gpu::Device& device, LightFieldScene& scene, float wanted, const BenchmarkScene& known);

/// Parses `--holes` of a benchmark. Throws UserError.
HoleFilling parse_holes(const std::string& text, const ViewGrid& grid);

} // namespace fieldcast::bench
