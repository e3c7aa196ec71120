// SPDX-License-Identifier: Apache-2.0
#include "core/render/denoise/svgf.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"

namespace fieldcast::render {

namespace {

/// Parameters in which SVGF and SVGF+ differ. The defaults are those of the SVGF paper.
struct Tuning {
    float sigma_luminance = 4.0F;
    float sigma_depth = 1.0F;
    std::uint32_t normal_squarings = 7; // exponent 2^7 = 128
    std::uint32_t levels = 5;
    int outer_radius = 2;               // radius in taps of the levels after the first
    float slow_share = 1.0F;            // share of α: least weight of a frame in illumination
    bool follows_lobes = false;
    bool limits_outliers = false;       // only in the last level; in earlier ones sparse light would be lost
    bool feeds_back = true;             // the first level's result replaces the history
};

constexpr Tuning kSvgf{};
constexpr Tuning kSvgfPlus{.sigma_luminance = 3.0F,
                           .sigma_depth = 1.0F,
                           .normal_squarings = 5,
                           .levels = 4,
                           .outer_radius = 1,
                           .slow_share = 1.0F / 6.0F,
                           .follows_lobes = true,
                           .limits_outliers = true,
                           .feeds_back = false};

const Tuning& tuning_of(Denoiser denoiser) {
    return denoiser == Denoiser::kSvgfPlus ? kSvgfPlus : kSvgf;
}

} // namespace

Svgf::Svgf(const gpu::Device& device, const Accumulation& accumulation)
    : device_(device), accumulation_(accumulation), layout_(device, texel_bindings(5)),
      variance_(make_plain_kernel(device, KernelId::kSvgfVariance, sizeof(shared::FilterParams), {&layout_})),
      limit_history_(make_plain_kernel(device, KernelId::kLimitHistory, sizeof(shared::FilterParams), {&layout_})),
      atrous_(make_plain_kernel(device, KernelId::kSvgfAtrous, sizeof(shared::FilterParams), {&layout_})) {}

Accumulation::Options Svgf::accumulation_options(Denoiser denoiser) {
    const bool is_plus = denoiser == Denoiser::kSvgfPlus;
    return {.share = tuning_of(denoiser).slow_share, .is_sharp = is_plus, .follows_lobes = is_plus};
}

void Svgf::resize() {
    if (resize_count_ == accumulation_.resize_count()) {
        return;
    }
    resize_count_ = accumulation_.resize_count();
    texel_count_ = accumulation_.texel_count();
    for (Light& light : scratch_) {
        light.resize(device_, texel_count_);
    }
    bind();
}

void Svgf::bind() {
    for (std::uint32_t current = 0; current < 2; ++current) {
        const SourceHistory& now = accumulation_.histories()[current];
        for (std::uint32_t input = 0; input < 3; ++input) {
            gpu::BindingSet& set = sets_[current][input] = gpu::BindingSet(device_, layout_);
            set.set(shared::kFilterGeometry, now.geometry_view);
            set.set(shared::kFilterMoments, now.moments_view);
            set.set(shared::kFilterLength, now.length_view);
            const Light& light = input == 0 ? now.light : scratch_[input - 1];
            set.set(shared::kFilterDiffuse, light.diffuse.view);
            set.set(shared::kFilterSpecular, light.specular.view);
        }
    }
}

// Variance estimate, then the levels. In SVGF the first level's colour replaces the history (paper, section 4.3).
const Light& Svgf::record(gpu::CommandRecorder& recorder, const FilterFrame& frame) {
    resize();
    const Tuning& tuning = tuning_of(frame.settings.denoiser);
    shared::FilterParams params{};
    params.cameras = frame.cameras;
    params.groups = frame.groups->list().address();
    params.width = frame.width;
    params.height = frame.height;
    params.page_count = frame.page_count;
    params.source_count = frame.source_count;
    params.sigma_luminance = tuning.sigma_luminance;
    params.sigma_depth = tuning.sigma_depth;
    params.normal_squarings = tuning.normal_squarings;
    params.follows_lobes = tuning.follows_lobes ? 1 : 0;
    params.alpha = frame.settings.temporal_alpha * tuning.slow_share;
    recorder.stage("denoise");
    std::uint32_t input = 0; // index of the binding set: 0 history, 1 and 2 scratch
    const auto run = [&](const gpu::Kernel& kernel, std::uint32_t output) {
        params.diffuse = scratch_[output - 1].diffuse.buffer.address();
        params.specular = scratch_[output - 1].specular.buffer.address();
        dispatch_listed(recorder, kernel, {&sets_[accumulation_.current()][input]}, params, *frame.groups);
        recorder.barrier();
        input = output;
    };
    run(tuning.feeds_back ? variance_ : limit_history_, 1);
    if (!tuning.feeds_back) {
        keep_as_history(recorder, scratch_[0]);
    }
    for (std::uint32_t level = 0; level < tuning.levels; ++level) {
        params.step = 1U << level;
        params.radius = level == 0 ? 2 : tuning.outer_radius;
        params.limits_outliers = tuning.limits_outliers && level + 1 == tuning.levels ? 1 : 0;
        run(atrous_, input == 1 ? 2 : 1);
        if (level == 0 && tuning.feeds_back) {
            keep_as_history(recorder, scratch_[input - 1]);
        }
    }
    return scratch_[input - 1];
}

void Svgf::keep_as_history(gpu::CommandRecorder& recorder, const Light& light) {
    const std::uint64_t bytes = static_cast<std::uint64_t>(texel_count_) * 16;
    recorder.copy(light.diffuse.buffer, accumulation_.now().light.diffuse.buffer, bytes);
    recorder.copy(light.specular.buffer, accumulation_.now().light.specular.buffer, bytes);
}

} // namespace fieldcast::render
