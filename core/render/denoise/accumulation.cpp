// SPDX-License-Identifier: Apache-2.0
#include "core/render/denoise/accumulation.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"

namespace fieldcast::render {

namespace {

constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;

} // namespace

std::vector<gpu::Binding> texel_bindings(std::uint32_t count) {
    std::vector<gpu::Binding> bindings;
    for (std::uint32_t i = 0; i < count; ++i) {
        bindings.push_back({i, gpu::BindingType::kTexelBuffer, 1});
    }
    return bindings;
}

void LightBuffer::resize(const gpu::Device& device, std::uint32_t pixel_count) {
    buffer = gpu::make_zero_buffer(device, static_cast<std::uint64_t>(pixel_count) * 16);
    view = gpu::TexelView(device, buffer, kFloats);
}

void Light::resize(const gpu::Device& device, std::uint32_t pixel_count) {
    diffuse.resize(device, pixel_count);
    specular.resize(device, pixel_count);
}

void SourceHistory::resize(const gpu::Device& device, std::uint32_t pixel_count) {
    const std::uint64_t count = pixel_count;
    geometry = gpu::Buffer(device, count * 16);
    light.resize(device, pixel_count);
    moments = gpu::make_zero_buffer(device, count * 16);
    length = gpu::make_zero_buffer(device, count * 4);
    geometry_view = gpu::TexelView(device, geometry, VK_FORMAT_R32G32B32A32_UINT);
    moments_view = gpu::TexelView(device, moments, kFloats);
    length_view = gpu::TexelView(device, length, VK_FORMAT_R32_SFLOAT);
}

Accumulation::Accumulation(const gpu::Device& device, const scene::GpuScene& scene)
    : device_(device), scene_(scene), layout_(device, texel_bindings(10)),
      kernel_(make_scene_kernel(device, scene, KernelId::kTemporal, sizeof(shared::TemporalParams), {&layout_})) {}

void Accumulation::resize(std::uint32_t texel_count, bool is_punctual_apart) {
    if (texel_count == texel_count_ && is_punctual_apart == static_cast<bool>(noisy_punctual_.buffer)) {
        return;
    }
    ++resize_count_;
    texel_count_ = texel_count;
    for (SourceHistory& history : history_) {
        history.resize(device_, texel_count);
        history.punctual = {};
    }
    noisy_.resize(device_, texel_count);
    noisy_punctual_ = {};
    if (is_punctual_apart) {
        noisy_punctual_.resize(device_, texel_count);
        for (SourceHistory& history : history_) {
            history.punctual.resize(device_, texel_count);
        }
    }
    taps_ = {};
    bind();
}

void Accumulation::bind() {
    for (std::uint32_t current = 0; current < 2; ++current) {
        const SourceHistory& now = history_[current];
        const SourceHistory& before = history_[1 - current];
        gpu::BindingSet& set = sets_[current] = gpu::BindingSet(device_, layout_);
        set.set(shared::kTemporalGeometry, now.geometry_view);
        set.set(shared::kTemporalPreviousGeometry, before.geometry_view);
        set.set(shared::kTemporalPreviousDiffuse, before.light.diffuse.view);
        set.set(shared::kTemporalPreviousSpecular, before.light.specular.view);
        set.set(shared::kTemporalPreviousMoments, before.moments_view);
        set.set(shared::kTemporalPreviousLength, before.length_view);
        set.set(shared::kTemporalDiffuse, noisy_.diffuse.view);
        set.set(shared::kTemporalSpecular, noisy_.specular.view);
        // Kernels read this binding only if punctual light is accumulated apart.
        const bool is_apart = static_cast<bool>(noisy_punctual_.buffer);
        set.set(shared::kTemporalPunctual, is_apart ? noisy_punctual_.view : noisy_.diffuse.view);
        set.set(shared::kTemporalPreviousPunctual, is_apart ? before.punctual.view : before.light.diffuse.view);
    }
}

void Accumulation::record(gpu::CommandRecorder& recorder, const FilterFrame& frame, const Options& options) {
    if (options.keeps_taps && !taps_) {
        taps_ = gpu::Buffer(device_, static_cast<std::uint64_t>(texel_count_) * sizeof(shared::HistoryTaps));
    }
    shared::TemporalParams params{};
    params.cameras = frame.cameras;
    params.visibility = frame.visibility;
    params.layers = frame.layers;
    params.diffuse = now().light.diffuse.buffer.address();
    params.specular = now().light.specular.buffer.address();
    params.moments = now().moments.address();
    params.punctual = frame.is_punctual_apart ? now().punctual.buffer.address() : 0;
    params.history_length = now().length.address();
    params.taps = options.keeps_taps ? taps_.address() : 0;
    params.groups = frame.groups->list().address();
    params.width = frame.width;
    params.height = frame.height;
    params.page_count = frame.page_count;
    params.source_count = frame.source_count;
    params.flags =
        (frame.has_history ? shared::kFlagTemporal : 0) | (options.is_sharp ? shared::kFlagSharpHistory : 0) |
        (options.follows_lobes ? shared::kFlagFollowLobes : 0) | (options.keeps_taps ? shared::kFlagKeepTaps : 0) |
        (frame.is_punctual_apart ? shared::kFlagPunctualApart : 0);
    params.alpha = frame.least_weight * options.share;
    params.moments_alpha = frame.least_weight;
    recorder.stage("temporal");
    dispatch_listed(recorder, kernel_, {&scene_.bindings(), &sets_[current_]}, params, *frame.groups);
    recorder.barrier();
}

} // namespace fieldcast::render
