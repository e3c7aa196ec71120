// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/accumulation.h"
#include "shaders/shared/bmfr.h"

namespace fieldcast::render {

/// Blocks of 32×32 pixels whose accumulated illumination is fitted to features of the surfaces: constant, shading
/// normal, position, its square; evaluated per pixel and accumulated again. The blocks move from frame to frame. M.
/// Koskela et al. Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction. ACM TOG 38(5),
/// 2019. Where a fit leaves more over than noise, or has few pixels, an edge-stopping mean of the neighbours stands in.
class Bmfr {
public:
    Bmfr(const gpu::Device& device, const Accumulation& accumulation);

    /// How light has to be accumulated for this filter.
    static Accumulation::Options accumulation_options() { return {.keeps_taps = true}; }

    /// After the accumulation. The result stays valid until the call after the next.
    const Light& record(gpu::Recorder& recorder, const FilterFrame& frame);

    /// What record() filtered last is not the frame before the next one.
    void forget() { has_filtered_ = false; }

    /// Blocks of one page: columns, rows.
    static glm::uvec2 block_counts(std::uint32_t width, std::uint32_t height);
    /// Pixel in which the first block begins; −32 to −2.
    static glm::ivec2 first_pixel(std::uint32_t frame);
    const gpu::Buffer& fits() const { return fits_; } ///< of the last record(): BlockFit, row by row, page by page

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
    std::array<Light, 2> filtered_;       ///< by the accumulation's current history
    std::array<gpu::BindingSet, 2> sets_; ///< likewise
    bool has_filtered_ = false;
};

} // namespace fieldcast::render
