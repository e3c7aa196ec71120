// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/accumulation.h"

namespace fieldcast::render {

/// The à-trous filter of SVGF over accumulated diffuse and specular illumination.
/// C. Schied et al. Spatiotemporal Variance-Guided Filtering. HPG 2017.
/// SVGF+ differs: its history is six times as long and is limited by a short one. The variance of the history narrows
/// the filter, and the outer levels have 3×3 taps. Filtered light does not enter the history.
class Svgf {
public:
    Svgf(const gpu::Device& device, const Accumulation& accumulation);

    /// Accumulation options that this filter requires.
    static Accumulation::Options accumulation_options(Denoiser denoiser);

    /// Records the filter; call after Accumulation::record(). The result stays valid until the next call.
    const Light& record(gpu::CommandRecorder& recorder, const FilterFrame& frame);

private:
    void resize();
    void bind();
    void keep_as_history(gpu::CommandRecorder& recorder, const Light& light);

    const gpu::Device& device_;
    const Accumulation& accumulation_;
    gpu::BindingLayout layout_;
    gpu::Kernel variance_;
    gpu::Kernel limit_history_;
    gpu::Kernel atrous_;
    std::uint64_t resize_count_ = 0;
    std::uint32_t texel_count_ = 0;
    std::array<Light, 2> scratch_;                       ///< ping-pong
    std::array<std::array<gpu::BindingSet, 3>, 2> sets_; ///< [current history][input: history, scratch 0, scratch 1]
};

} // namespace fieldcast::render
