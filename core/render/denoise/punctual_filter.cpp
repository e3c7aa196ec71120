// SPDX-License-Identifier: Apache-2.0
#include "core/render/denoise/punctual_filter.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"

namespace fieldcast::render {

namespace {

constexpr std::uint32_t kLevels = 2;

} // namespace

PunctualFilter::PunctualFilter(const gpu::Device& device, const Accumulation& accumulation)
    : device_(device), accumulation_(accumulation), layout_(device, texel_bindings(5)),
      kernel_(make_plain_kernel(device, KernelId::kFilterPunctual, sizeof(shared::FilterPunctualParams), {&layout_})) {}

void PunctualFilter::resize() {
    if (resize_count_ == accumulation_.resize_count()) {
        return;
    }
    resize_count_ = accumulation_.resize_count();
    for (LightBuffer& light : scratch_) {
        light.resize(device_, accumulation_.texel_count());
    }
    bind();
}

void PunctualFilter::bind() {
    for (std::uint32_t current = 0; current < 2; ++current) {
        const SourceHistory& now = accumulation_.histories()[current];
        for (std::uint32_t input = 0; input < 3; ++input) {
            gpu::BindingSet& set = sets_[current][input] = gpu::BindingSet(device_, layout_);
            const LightBuffer& light = input == 0 ? now.punctual : scratch_[input - 1];
            set.set(shared::kFilterGeometry, now.geometry_view);
            set.set(shared::kFilterMoments, now.moments_view);
            set.set(shared::kFilterLength, now.length_view);
            set.set(shared::kFilterDiffuse, light.view);
            set.set(shared::kFilterSpecular, light.view); // bound, but the kernel does not read it
        }
    }
}

const gpu::Buffer& PunctualFilter::record(gpu::CommandRecorder& recorder, const FilterFrame& frame) {
    resize();
    shared::FilterPunctualParams params{};
    params.cameras = frame.cameras;
    params.groups = frame.groups->list().address();
    params.width = frame.width;
    params.height = frame.height;
    params.page_count = frame.page_count;
    params.source_count = frame.source_count;
    params.sigma_luminance = 1.0F; // below SVGF+, because this light has little noise
    params.sigma_depth = 1.0F;     // as in SVGF+
    params.normal_squarings = 5;
    params.alpha = frame.least_weight;
    recorder.stage("denoise_punctual");
    std::uint32_t input = 0; // index of the binding set: 0 history, 1 and 2 scratch
    for (std::uint32_t level = 0; level < kLevels; ++level) {
        const std::uint32_t output = input == 1 ? 2 : 1;
        params.step = 1U << level;
        params.radius = level == 0 ? 2 : 1;
        params.has_moments = level == 0 ? 1 : 0;
        params.punctual = scratch_[output - 1].buffer.address();
        dispatch_listed(recorder, kernel_, {&sets_[accumulation_.current()][input]}, params, *frame.groups);
        recorder.barrier();
        input = output;
    }
    return scratch_[input - 1].buffer;
}

} // namespace fieldcast::render
