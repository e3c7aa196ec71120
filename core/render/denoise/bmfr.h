// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/accumulation.h"
#include "shaders/shared/bmfr.h"

namespace fieldcast::render {

/// Fits the accumulated illumination of blocks of 32×32 pixels to features of the surfaces: constant, shading normal,
/// position, and its square. The fit is evaluated per pixel and accumulated again; the blocks move from frame to frame.
/// M. Koskela et al. Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction. ACM TOG 38(5),
/// 2019. Differs: an edge-stopping mean of the neighbours replaces a fit that has few pixels, or whose residual exceeds
/// the noise.
class Bmfr {
public:
    Bmfr(const gpu::Device& device, const Accumulation& accumulation);

    /// Accumulation options that this filter requires.
    static Accumulation::Options accumulation_options() { return {.keeps_taps = true}; }

    /// Records the filter; call after Accumulation::record(). The result stays valid until the call after the next.
    const Light& record(gpu::CommandRecorder& recorder, const FilterFrame& frame);

    /// Drops the filtered history: the frame of the last record() does not directly precede the next one.
    void forget() { has_filtered_ = false; }

    /// Blocks of one page: columns, rows.
    static glm::uvec2 block_counts(std::uint32_t width, std::uint32_t height);
    /// Pixel in which the first block of a frame begins; −32 to −2 in each direction.
    static glm::ivec2 first_pixel(std::uint32_t frame);
    const gpu::Buffer& fits() const { return fits_; } ///< BlockFits of the last record(), row by row, page by page

private:
    void resize(std::uint32_t block_count);
    void bind();

    const gpu::Device& device_;
    const Accumulation& accumulation_;
    gpu::BindingLayout layout_;
    gpu::Kernel fit_;
    gpu::Kernel evaluate_;
    std::uint64_t resize_count_ = 0;
    gpu::Buffer fits_;
    std::array<Light, 2> filtered_;       ///< indexed by the accumulation's current()
    std::array<gpu::BindingSet, 2> sets_; ///< indexed likewise
    bool has_filtered_ = false;
};

} // namespace fieldcast::render
