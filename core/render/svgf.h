// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/lightfield/render_settings.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/frame.h"

#include <array>

namespace fieldcast::render {

/// Per-pixel data of the source that survives a frame.
struct SourceHistory {
    gpu::Buffer geometry; ///< GeometryTexel
    gpu::Buffer diffuse;  ///< rgb, variance
    gpu::Buffer specular;
    gpu::Buffer moments;
    gpu::Buffer length;
    gpu::TexelView geometry_view;
    gpu::TexelView diffuse_view;
    gpu::TexelView specular_view;
    gpu::TexelView moments_view;
    gpu::TexelView length_view;

    void resize(const gpu::Device& device, std::uint32_t pixel_count);
};

/// Temporal accumulation and the à-trous filter of SVGF over diffuse and specular illumination.
/// C. Schied et al. Spatiotemporal Variance-Guided Filtering. HPG 2017.
/// Or SVGF+: a history six times as long, limited by a short one; what is known of its variance narrows the filter, whose
/// outer levels have 3×3 taps; what was filtered does not enter the history.
class Svgf {
public:
    Svgf(const gpu::Device& device, const scene::GpuScene& scene);

    /// What one frame consists of. `cameras`: of the sources now, then as they were.
    struct Frame {
        std::uint64_t cameras = 0;
        std::uint64_t visibility = 0;
        std::uint64_t layers = 0;
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::uint32_t page_count = 1;
        std::uint32_t source_count = 1;
        bool has_history = false;
        RenderSettings settings;
    };

    void resize(std::uint32_t texel_count); ///< pixels of all pages

    /// Where the path tracer writes its noisy illumination, and source_surfaces.comp the geometry of this frame.
    const gpu::Buffer& noisy_diffuse() const { return noisy_[0]; }
    const gpu::Buffer& noisy_specular() const { return noisy_[1]; }
    const gpu::Buffer& geometry() const { return history_[current_].geometry; }

    /// Records accumulation (if the settings ask for it) and filtering. The result is in `diffuse()` and `specular()`.
    void record(gpu::Recorder& recorder, const Frame& frame);
    const gpu::Buffer& diffuse() const { return *result_diffuse_; }
    const gpu::Buffer& specular() const { return *result_specular_; }

    /// This frame's data become the history of the next one.
    void swap() { current_ = 1 - current_; }

private:
    void bind();
    void record_temporal(gpu::Recorder& recorder, const Frame& frame);
    void record_filter(gpu::Recorder& recorder, const Frame& frame);
    void keep_as_history(gpu::Recorder& recorder, std::uint32_t scratch);

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::BindingLayout temporal_layout_;
    gpu::BindingLayout filter_layout_;
    gpu::Kernel temporal_;
    gpu::Kernel variance_;
    gpu::Kernel limit_history_;
    gpu::Kernel atrous_;
    std::uint32_t texel_count_ = 0;
    std::uint32_t current_ = 0;
    std::array<SourceHistory, 2> history_;
    std::array<gpu::Buffer, 2> noisy_;
    std::array<gpu::TexelView, 2> noisy_views_;
    std::array<std::array<gpu::Buffer, 2>, 2> scratch_; ///< [ping-pong][diffuse, specular]
    std::array<std::array<gpu::TexelView, 2>, 2> scratch_views_;
    std::array<gpu::BindingSet, 2> temporal_sets_;                ///< by current_
    std::array<std::array<gpu::BindingSet, 3>, 2> filter_sets_;   ///< by current_: reads history, scratch 0, scratch 1
    const gpu::Buffer* result_diffuse_ = nullptr;
    const gpu::Buffer* result_specular_ = nullptr;
};

} // namespace fieldcast::render
