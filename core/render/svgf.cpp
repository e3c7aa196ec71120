// SPDX-License-Identifier: Apache-2.0
#include "core/render/svgf.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"

namespace fieldcast::render {

namespace {

constexpr std::uint32_t kLevels = 5;

/// What tells SVGF+ from SVGF, whose values are those of its paper.
struct Tuning {
    float sigma_luminance = 4.0F;
    float sigma_depth = 1.0F;
    std::uint32_t normal_squarings = 7; // 128
    int outer_radius = 2;               // taps of the levels after the first
    float slow_share = 1.0F;            // of α: least weight of a frame in illumination
    bool limits_outliers = false; // in the last level: earlier, sparse light would be lost
    bool feeds_back = true;       // the first level's result replaces the history
};

constexpr Tuning kSvgf{};
constexpr Tuning kSvgfPlus{.sigma_luminance = 1.5F,
                           .sigma_depth = 1.0F,
                           .normal_squarings = 5,
                           .outer_radius = 1,
                           .slow_share = 1.0F / 6.0F,
                           .limits_outliers = true,
                           .feeds_back = false};

const Tuning& tuning_of(const RenderSettings& settings) {
    return settings.denoiser == Denoiser::kSvgfPlus ? kSvgfPlus : kSvgf;
}

constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;

std::vector<gpu::Binding> texel_bindings(std::uint32_t count) {
    std::vector<gpu::Binding> bindings;
    for (std::uint32_t i = 0; i < count; ++i) {
        bindings.push_back({i, gpu::BindingType::kTexelBuffer, 1});
    }
    return bindings;
}

} // namespace

void SourceHistory::resize(const gpu::Device& device, std::uint32_t pixel_count) {
    const std::uint64_t count = pixel_count;
    geometry = gpu::Buffer(device, count * 16);
    diffuse = gpu::Buffer(device, count * 16);
    specular = gpu::Buffer(device, count * 16);
    moments = gpu::Buffer(device, count * 16);
    length = gpu::Buffer(device, count * 4);
    geometry_view = gpu::TexelView(device, geometry, VK_FORMAT_R32G32B32A32_UINT);
    diffuse_view = gpu::TexelView(device, diffuse, kFloats);
    specular_view = gpu::TexelView(device, specular, kFloats);
    moments_view = gpu::TexelView(device, moments, kFloats);
    length_view = gpu::TexelView(device, length, VK_FORMAT_R32_SFLOAT);
}

Svgf::Svgf(const gpu::Device& device, const scene::GpuScene& scene)
    : device_(device), scene_(scene), temporal_layout_(device, texel_bindings(8)),
      filter_layout_(device, texel_bindings(5)),
      temporal_(make_scene_kernel(device, scene, KernelId::kTemporal, sizeof(shared::TemporalParams),
                                  {&temporal_layout_})),
      variance_(make_plain_kernel(device, KernelId::kSvgfVariance, sizeof(shared::FilterParams), {&filter_layout_})),
      limit_history_(make_plain_kernel(device, KernelId::kLimitHistory, sizeof(shared::FilterParams), {&filter_layout_})),
      atrous_(make_plain_kernel(device, KernelId::kSvgfAtrous, sizeof(shared::FilterParams), {&filter_layout_})) {}

void Svgf::resize(std::uint32_t texel_count) {
    if (texel_count == texel_count_) {
        return;
    }
    texel_count_ = texel_count;
    for (SourceHistory& history : history_) {
        history.resize(device_, texel_count);
    }
    const auto make = [&](gpu::Buffer& buffer, gpu::TexelView& view) {
        buffer = gpu::Buffer(device_, static_cast<std::uint64_t>(texel_count) * 16);
        view = gpu::TexelView(device_, buffer, kFloats);
    };
    for (std::uint32_t i = 0; i < 2; ++i) {
        make(noisy_[i], noisy_views_[i]);
        make(scratch_[0][i], scratch_views_[0][i]);
        make(scratch_[1][i], scratch_views_[1][i]);
    }
    bind();
}

void Svgf::bind() {
    for (std::uint32_t current = 0; current < 2; ++current) {
        const SourceHistory& now = history_[current];
        const SourceHistory& before = history_[1 - current];
        gpu::BindingSet& temporal = temporal_sets_[current] = gpu::BindingSet(device_, temporal_layout_);
        temporal.set(shared::kTemporalGeometry, now.geometry_view);
        temporal.set(shared::kTemporalPreviousGeometry, before.geometry_view);
        temporal.set(shared::kTemporalPreviousDiffuse, before.diffuse_view);
        temporal.set(shared::kTemporalPreviousSpecular, before.specular_view);
        temporal.set(shared::kTemporalPreviousMoments, before.moments_view);
        temporal.set(shared::kTemporalPreviousLength, before.length_view);
        temporal.set(shared::kTemporalDiffuse, noisy_views_[0]);
        temporal.set(shared::kTemporalSpecular, noisy_views_[1]);
        for (std::uint32_t input = 0; input < 3; ++input) {
            gpu::BindingSet& filter = filter_sets_[current][input] = gpu::BindingSet(device_, filter_layout_);
            filter.set(shared::kFilterGeometry, now.geometry_view);
            filter.set(shared::kFilterMoments, now.moments_view);
            filter.set(shared::kFilterLength, now.length_view);
            filter.set(shared::kFilterDiffuse, input == 0 ? now.diffuse_view : scratch_views_[input - 1][0]);
            filter.set(shared::kFilterSpecular, input == 0 ? now.specular_view : scratch_views_[input - 1][1]);
        }
    }
}

void Svgf::record(gpu::Recorder& recorder, const Frame& frame) {
    result_diffuse_ = &noisy_[0];
    result_specular_ = &noisy_[1];
    const bool filters = frame.settings.denoiser != Denoiser::kNone;
    if (frame.settings.temporal_accumulation || filters) {
        record_temporal(recorder, frame);
    }
    if (filters) {
        record_filter(recorder, frame);
    }
}

void Svgf::record_temporal(gpu::Recorder& recorder, const Frame& frame) {
    const SourceHistory& now = history_[current_];
    shared::TemporalParams params{};
    params.cameras = frame.cameras;
    params.visibility = frame.visibility;
    params.layers = frame.layers;
    params.diffuse = now.diffuse.address();
    params.specular = now.specular.address();
    params.moments = now.moments.address();
    params.history_length = now.length.address();
    params.width = frame.width;
    params.height = frame.height;
    params.page_count = frame.page_count;
    params.source_count = frame.source_count;
    const Tuning& tuning = tuning_of(frame.settings);
    params.flags = frame.has_history && frame.settings.temporal_accumulation ? shared::kFlagTemporal : 0;
    params.alpha = frame.settings.temporal_alpha * tuning.slow_share;
    params.moments_alpha = frame.settings.temporal_alpha;
    recorder.stage("temporal");
    recorder.dispatch(temporal_, {&scene_.bindings(), &temporal_sets_[current_]}, params,
                      linear_groups(texel_count_));
    recorder.barrier();
    result_diffuse_ = &now.diffuse;
    result_specular_ = &now.specular;
}

// Variance estimate, then five levels. SVGF: the first level's colour replaces the history (SVGF, section 4.3).
void Svgf::record_filter(gpu::Recorder& recorder, const Frame& frame) {
    const Tuning& tuning = tuning_of(frame.settings);
    shared::FilterParams params{};
    params.cameras = frame.cameras;
    params.width = frame.width;
    params.height = frame.height;
    params.page_count = frame.page_count;
    params.source_count = frame.source_count;
    params.sigma_luminance = tuning.sigma_luminance;
    params.sigma_depth = tuning.sigma_depth;
    params.normal_squarings = tuning.normal_squarings;
    params.alpha = frame.settings.temporal_alpha * tuning.slow_share;
    const gpu::GroupCount groups = linear_groups(texel_count_);
    recorder.stage("denoise");
    std::uint32_t input = 0; // filter set: 0 history, 1 and 2 scratch
    const auto run = [&](const gpu::Kernel& kernel, std::uint32_t output) {
        params.diffuse = scratch_[output - 1][0].address();
        params.specular = scratch_[output - 1][1].address();
        recorder.dispatch(kernel, {&filter_sets_[current_][input]}, params, groups);
        recorder.barrier();
        input = output;
    };
    run(tuning.feeds_back ? variance_ : limit_history_, 1);
    if (!tuning.feeds_back) {
        keep_as_history(recorder, 0);
    }
    for (std::uint32_t level = 0; level < kLevels; ++level) {
        params.step = 1U << level;
        params.radius = level == 0 ? 2 : tuning.outer_radius;
        params.limits_outliers = tuning.limits_outliers && level + 1 == kLevels ? 1 : 0;
        run(atrous_, input == 1 ? 2 : 1);
        if (level == 0 && tuning.feeds_back) {
            keep_as_history(recorder, input - 1);
        }
    }
    result_diffuse_ = &scratch_[input - 1][0];
    result_specular_ = &scratch_[input - 1][1];
}

void Svgf::keep_as_history(gpu::Recorder& recorder, std::uint32_t scratch) {
    const std::uint64_t bytes = static_cast<std::uint64_t>(texel_count_) * 16;
    recorder.copy(scratch_[scratch][0], history_[current_].diffuse, bytes);
    recorder.copy(scratch_[scratch][1], history_[current_].specular, bytes);
}

} // namespace fieldcast::render
