// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/accumulation.h"

namespace fieldcast::render {

/// Filters diffuse light that comes straight from punctual lights, which is accumulated apart: two levels of SVGF+'s
/// edge-avoiding filter, led by the variance of this light alone. Shadows of a sun stay sharp however noisy the sky is.
class PunctualFilter {
public:
    PunctualFilter(const gpu::Device& device, const Accumulation& accumulation);

    /// After the accumulation. The result, rgb and variance, stays valid until the next call.
    const gpu::Buffer& record(gpu::Recorder& recorder, const FilterFrame& frame);

private:
    void resize();
    void bind();

    const gpu::Device& device_;
    const Accumulation& accumulation_;
    gpu::BindingLayout layout_;
    gpu::Kernel kernel_;
    std::uint64_t resize_count_ = 0;
    std::array<LightBuffer, 2> scratch_;                 ///< ping-pong
    std::array<std::array<gpu::BindingSet, 3>, 2> sets_; ///< by current history: reads that, scratch 0, scratch 1
};

} // namespace fieldcast::render
