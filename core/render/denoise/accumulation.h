// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/render_settings.h"
#include "core/render/group_list.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/frame.h"

#include <array>

namespace fieldcast::render {

/// Rgb and alpha per pixel of all pages, for kernels that write it and kernels that fetch it. 0 at first: filters
/// multiply by 0 what pixels hold that they did not run on.
struct LightBuffer {
    gpu::Buffer buffer;
    gpu::TexelView view;

    void resize(const gpu::Device& device, std::uint32_t pixel_count);
};

/// Diffuse and specular illumination of the source.
struct Light {
    LightBuffer diffuse;
    LightBuffer specular;

    void resize(const gpu::Device& device, std::uint32_t pixel_count);
};

/// Per-pixel data of the source that survives a frame.
struct SourceHistory {
    gpu::Buffer geometry; ///< GeometryTexel
    Light light;          ///< rgb, variance
    gpu::Buffer moments;
    gpu::Buffer length;
    LightBuffer punctual; ///< rgb, second moment of luminance; empty unless it is kept apart
    gpu::TexelView geometry_view;
    gpu::TexelView moments_view;
    gpu::TexelView length_view;

    void resize(const gpu::Device& device, std::uint32_t pixel_count);
};

/// What the passes over the source's illumination know of one frame. `cameras`: of the sources now, then as
/// they were.
struct FilterFrame {
    std::uint64_t cameras = 0;
    std::uint64_t visibility = 0;
    std::uint64_t layers = 0;
    const GroupList* groups = nullptr; ///< to run on
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t page_count = 1;
    std::uint32_t source_count = 1;
    bool has_history = false;       ///< that may enter the average
    bool is_punctual_apart = false; ///< as the accumulation was resized
    bool is_still = false;          ///< one of a series that is averaged and not filtered
    float least_weight = 1.0F;      ///< of the new frame in the average
    std::uint32_t number = 0;       ///< of the frame: what varies from frame to frame
    RenderSettings settings;
};

/// Layout of a set of `count` texel buffers.
std::vector<gpu::Binding> texel_bindings(std::uint32_t count);

/// Noisy illumination of the frame and its average over the frames before, along surface motion (temporal.comp).
class Accumulation {
public:
    Accumulation(const gpu::Device& device, const scene::GpuScene& scene);

    /// `texel_count`: pixels of all pages. `is_punctual_apart`: light straight from punctual lights has a history of
    /// its own, short and unlimited, so that the noise of other light does not blur its shadows.
    void resize(std::uint32_t texel_count, bool is_punctual_apart = false);
    std::uint64_t resize_count() const { return resize_count_; } ///< changes whenever its buffers do
    std::uint32_t texel_count() const { return texel_count_; }

    /// The new frame's share of the average is at least `share` · least_weight. `is_sharp`: the history is interpolated
    /// with Catmull-Rom weights where it can be. `follows_lobes`: specular light counts as old once the lobe that the
    /// surface reflects to the camera has turned. `keeps_taps`: fills `taps()`.
    struct Options {
        float share = 1.0F;
        bool is_sharp = false;
        bool follows_lobes = false;
        bool keeps_taps = false;
    };
    void record(gpu::Recorder& recorder, const FilterFrame& frame, const Options& options);

    const Light& noisy() const { return noisy_; }
    const LightBuffer& noisy_punctual() const { return noisy_punctual_; } ///< empty unless it is kept apart
    /// Of this frame: its geometry from the beginning, the rest once record() ran. Filters may replace its
    /// illumination.
    const SourceHistory& now() const { return history_[current_]; }
    const SourceHistory& before() const { return history_[1 - current_]; }     ///< of the last one
    const std::array<SourceHistory, 2>& histories() const { return history_; } ///< now() is histories()[current()]
    std::uint32_t current() const { return current_; }
    const gpu::Buffer& taps() const { return taps_; } ///< HistoryTaps: the pixels of the frame before that entered

    /// This frame's data become the history of the next one.
    void swap() { current_ = 1 - current_; }

private:
    void bind();

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::BindingLayout layout_;
    gpu::Kernel kernel_;
    std::uint64_t resize_count_ = 0;
    std::uint32_t texel_count_ = 0;
    std::uint32_t current_ = 0;
    std::array<SourceHistory, 2> history_;
    Light noisy_;
    LightBuffer noisy_punctual_;
    gpu::Buffer taps_;
    std::array<gpu::BindingSet, 2> sets_; ///< by current_
};

} // namespace fieldcast::render
