// SPDX-License-Identifier: Apache-2.0
#include "core/render/denoise/bmfr.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"

namespace fieldcast::render {

namespace {

constexpr float kFilteredShare = 0.5F; // of α: the paper uses 0.1 here and 0.2 for noisy light

/// Offsets in pixels of the grid of blocks in sixteen successive frames, as in the paper. They hide block edges.
constexpr std::array kGridOffsets{glm::ivec2(-14, -14), glm::ivec2(4, -6),   glm::ivec2(-8, 14),  glm::ivec2(8, 0),
                                  glm::ivec2(-10, -8),  glm::ivec2(2, 12),   glm::ivec2(12, -12), glm::ivec2(-10, 0),
                                  glm::ivec2(12, 14),   glm::ivec2(-8, -16), glm::ivec2(6, 6),    glm::ivec2(-2, -2),
                                  glm::ivec2(6, -14),   glm::ivec2(-16, 12), glm::ivec2(14, -4),  glm::ivec2(-6, 4)};

} // namespace

Bmfr::Bmfr(const gpu::Device& device, const Accumulation& accumulation)
    : device_(device), accumulation_(accumulation), layout_(device, texel_bindings(7)),
      fit_(make_plain_kernel(device, KernelId::kBmfrFit, sizeof(shared::BmfrParams), {&layout_})),
      evaluate_(make_plain_kernel(device, KernelId::kBmfrEvaluate, sizeof(shared::BmfrParams), {&layout_})) {}

glm::uvec2 Bmfr::block_counts(std::uint32_t width, std::uint32_t height) {
    return {gpu::groups_for(width, shared::kFitSide) + 1, gpu::groups_for(height, shared::kFitSide) + 1};
}

glm::ivec2 Bmfr::first_pixel(std::uint32_t frame) {
    return kGridOffsets[frame % kGridOffsets.size()] - static_cast<int>(shared::kFitSide / 2);
}

void Bmfr::resize(std::uint32_t block_count) {
    const std::uint64_t bytes = std::uint64_t{block_count} * sizeof(shared::BlockFit);
    if (fits_.size_bytes() < bytes) {
        fits_ = gpu::Buffer(device_, bytes);
    }
    if (resize_count_ == accumulation_.resize_count()) {
        return;
    }
    resize_count_ = accumulation_.resize_count();
    has_filtered_ = false;
    for (Light& light : filtered_) {
        light.resize(device_, accumulation_.texel_count());
    }
    bind();
}

void Bmfr::bind() {
    for (std::uint32_t current = 0; current < 2; ++current) {
        const SourceHistory& now = accumulation_.histories()[current];
        gpu::BindingSet& set = sets_[current] = gpu::BindingSet(device_, layout_);
        set.set(shared::kFilterGeometry, now.geometry_view);
        set.set(shared::kFilterDiffuse, now.light.diffuse.view);
        set.set(shared::kFilterSpecular, now.light.specular.view);
        set.set(shared::kFilterMoments, now.moments_view);
        set.set(shared::kFilterLength, now.length_view);
        set.set(shared::kBmfrPreviousDiffuse, filtered_[1 - current].diffuse.view);
        set.set(shared::kBmfrPreviousSpecular, filtered_[1 - current].specular.view);
    }
}

const Light& Bmfr::record(gpu::CommandRecorder& recorder, const FilterFrame& frame) {
    const glm::uvec2 blocks = block_counts(frame.width, frame.height);
    resize(blocks.x * blocks.y * frame.page_count);
    const Light& result = filtered_[accumulation_.current()];
    shared::BmfrParams params{};
    params.cameras = frame.cameras;
    params.groups = frame.groups->list().address();
    params.fits = fits_.address();
    params.taps = accumulation_.taps().address();
    params.diffuse = result.diffuse.buffer.address();
    params.specular = result.specular.buffer.address();
    params.width = frame.width;
    params.height = frame.height;
    params.page_count = frame.page_count;
    params.source_count = frame.source_count;
    params.blocks = blocks;
    params.first = first_pixel(frame.number);
    params.flags = has_filtered_ && frame.has_history ? shared::kFlagTemporal : 0;
    params.sigma_depth = 1.0F; // as in SVGF
    params.normal_squarings = 5;
    params.alpha = frame.least_weight * kFilteredShare;
    const gpu::BindingSet& set = sets_[accumulation_.current()];
    recorder.stage("denoise");
    recorder.dispatch(fit_, {&set}, params, {blocks.x, blocks.y, frame.page_count});
    recorder.barrier();
    dispatch_listed(recorder, evaluate_, {&set}, params, *frame.groups);
    recorder.barrier();
    has_filtered_ = true;
    return result;
}

} // namespace fieldcast::render
