// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/render_settings.h"
#include "core/render/group_list.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/frame.h"

#include <array>

namespace fieldcast::render {

/// RGB and alpha per pixel of all pages, as a buffer for kernels that write and as a view for kernels that fetch.
/// Zero-initialised: filters give unprocessed pixels weight 0, so they must not hold NaN.
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

/// Per-pixel data of the source that the next frame reads.
struct SourceHistory {
    gpu::Buffer geometry; ///< GeometryTexel
    Light light;          ///< rgb, variance
    gpu::Buffer moments;
    gpu::Buffer length;
    LightBuffer punctual; ///< rgb, second moment of luminance; empty unless it is accumulated apart
    gpu::TexelView geometry_view;
    gpu::TexelView moments_view;
    gpu::TexelView length_view;

    void resize(const gpu::Device& device, std::uint32_t pixel_count);
};

/// Input of the passes over the source's illumination for one frame. `cameras`, `visibility` and `layers` are device
/// addresses; `cameras` holds the CameraRecords of this frame's sources, then those of the previous frame.
struct FilterFrame {
    std::uint64_t cameras = 0;
    std::uint64_t visibility = 0;
    std::uint64_t layers = 0;
    const GroupList* groups = nullptr; ///< groups of pixels that the passes run on
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t page_count = 1;
    std::uint32_t source_count = 1;
    bool has_history = false;       ///< the previous frame may enter the average
    bool is_punctual_apart = false; ///< the value passed to Accumulation::resize()
    bool is_still = false;          ///< part of a series of still frames, which is averaged and not filtered
    float least_weight = 1.0F;      ///< least weight of the new frame in the average
    std::uint32_t number = 0;       ///< number of the frame, from which per-frame offsets follow
    RenderSettings settings;
};

/// Layout of a set of `count` texel buffers.
std::vector<gpu::Binding> texel_bindings(std::uint32_t count);

/// Noisy illumination of the frame and its average over previous frames, along surface motion (temporal.comp).
class Accumulation {
public:
    Accumulation(const gpu::Device& device, const scene::GpuScene& scene);

    /// `texel_count`: pixels of all pages. `is_punctual_apart`: direct light of punctual lights has its own history,
    /// which is short and not limited by a shorter one. The noise of other light then does not blur its shadows.
    void resize(std::uint32_t texel_count, bool is_punctual_apart = false);
    std::uint64_t resize_count() const { return resize_count_; } ///< changes whenever resize() replaces the buffers
    std::uint32_t texel_count() const { return texel_count_; }

    /// The new frame's share of the average is at least `share` · least_weight. `is_sharp`: the history is interpolated
    /// with Catmull-Rom weights where all taps are valid. `follows_lobes`: specular history loses weight as the
    /// lobe that the surface reflects to the camera turns. `keeps_taps`: fills `taps()`.
    struct Options {
        float share = 1.0F;
        bool is_sharp = false;
        bool follows_lobes = false;
        bool keeps_taps = false;
    };
    void record(gpu::CommandRecorder& recorder, const FilterFrame& frame, const Options& options);

    const Light& noisy() const { return noisy_; }
    const LightBuffer& noisy_punctual() const { return noisy_punctual_; } ///< empty unless accumulated apart
    /// Data of this frame: the geometry is valid from the beginning, the rest after record(). Filters may replace the
    /// illumination.
    const SourceHistory& now() const { return history_[current_]; }
    const SourceHistory& before() const { return history_[1 - current_]; }     ///< data of the previous frame
    const std::array<SourceHistory, 2>& histories() const { return history_; } ///< now() is histories()[current()]
    std::uint32_t current() const { return current_; }
    const gpu::Buffer& taps() const { return taps_; } ///< HistoryTaps: previous pixels that entered the average

    /// Makes this frame's data the history of the next frame.
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
    std::array<gpu::BindingSet, 2> sets_; ///< indexed by current_
};

} // namespace fieldcast::render
