// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/accumulation.h"

namespace fieldcast::render {

/// The à-trous filter of SVGF over accumulated diffuse and specular illumination.
/// C. Schied et al. Spatiotemporal Variance-Guided Filtering. HPG 2017.
/// Or SVGF+: a history six times as long, limited by a short one; what is known of its variance narrows the filter,
/// whose outer levels have 3×3 taps; what was filtered does not enter the history.
class Svgf {
public:
    Svgf(const gpu::Device& device, const Accumulation& accumulation);

    /// How light has to be accumulated for this filter.
    static Accumulation::Options accumulation_options(Denoiser denoiser);

    /// After the accumulation. The result stays valid until the next call.
    const Light& record(gpu::Recorder& recorder, const FilterFrame& frame);

private:
    void resize();
    void bind();
    void keep_as_history(gpu::Recorder& recorder, const Light& light);

    const gpu::Device& device_;
    const Accumulation& accumulation_;
    gpu::BindingLayout layout_;
    gpu::Kernel variance_;
    gpu::Kernel limit_history_;
    gpu::Kernel atrous_;
    std::uint64_t resize_count_ = 0;
    std::uint32_t texel_count_ = 0;
    std::array<Light, 2> scratch_;                       ///< ping-pong
    std::array<std::array<gpu::BindingSet, 3>, 2> sets_; ///< by current history: reads that, scratch 0, scratch 1
};

} // namespace fieldcast::render
