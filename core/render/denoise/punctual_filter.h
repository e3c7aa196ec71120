// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/accumulation.h"

namespace fieldcast::render {

/// Filters direct diffuse light of punctual lights, which is accumulated apart. Two levels of SVGF+'s edge-avoiding
/// filter use the variance of this light alone, so a noisy sky does not blur the sun's shadows.
class PunctualFilter {
public:
    PunctualFilter(const gpu::Device& device, const Accumulation& accumulation);

    /// Records the filter; call after Accumulation::record(). The result (rgb, variance) stays valid until the next
    /// call.
    const gpu::Buffer& record(gpu::CommandRecorder& recorder, const FilterFrame& frame);

private:
    void resize();
    void bind();

    const gpu::Device& device_;
    const Accumulation& accumulation_;
    gpu::BindingLayout layout_;
    gpu::Kernel kernel_;
    std::uint64_t resize_count_ = 0;
    std::array<LightBuffer, 2> scratch_;                 ///< ping-pong
    std::array<std::array<gpu::BindingSet, 3>, 2> sets_; ///< [current history][input: history, scratch 0, scratch 1]
};

} // namespace fieldcast::render
