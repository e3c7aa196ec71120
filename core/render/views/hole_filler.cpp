// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/hole_filler.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "core/render/view_request.h"

namespace fieldcast::render {

namespace {

/// Makes `buffer` hold at least `bytes`, plus a quarter if it must be replaced. Replacing it loses its contents.
void grow(const gpu::Device& device, gpu::Buffer& buffer, std::uint64_t bytes) {
    if (!buffer || buffer.size_bytes() < bytes) {
        buffer = gpu::Buffer(device, bytes + bytes / 4);
    }
}

} // namespace

shared::HoleFrame HoleHistory::Frame::record() const {
    return {cameras.address(), words.address(), first.address(), pixels.address(), surfaces.address(), light.address()};
}

HoleFiller::HoleFiller(const gpu::Device& device, const scene::GpuScene& scene, const gpu::BindingLayout& source_layout)
    : device_(device), scene_(scene),
      count_(make_plain_kernel(device, KernelId::kCountHoles, sizeof(shared::HoleMapParams))),
      scan_(make_plain_kernel(device, KernelId::kScanHoles, sizeof(shared::HoleMapParams))),
      list_(make_plain_kernel(device, KernelId::kListHoles, sizeof(shared::HoleMapParams))),
      finish_(make_plain_kernel(device, KernelId::kFinishList, sizeof(shared::FinishListParams))),
      start_(make_scene_kernel(device, scene, KernelId::kStartHoles, sizeof(shared::HoleParams), {&source_layout})),
      trace_(make_scene_kernel(device, scene, KernelId::kTraceHoles, sizeof(shared::HoleParams), {&source_layout})),
      cascade_(make_scene_kernel(device, scene, KernelId::kCascadeHoles, sizeof(shared::HoleParams), {&source_layout})),
      filter_(make_scene_kernel(device, scene, KernelId::kFilterHoles, sizeof(shared::HoleParams), {&source_layout})),
      shade_(make_scene_kernel(device, scene, KernelId::kShadeHoles, sizeof(shared::HoleParams), {&source_layout})),
      keep_(make_plain_kernel(device, KernelId::kKeepHoles, sizeof(shared::KeepHolesParams))),
      frame_records_(device, 2 * sizeof(shared::HoleFrame)) {}

void HoleFiller::forget() {
    batch_ = {};
    blocks_ = {};
    lists_ = {};
    filtered_ = {};
}

void HoleFiller::begin(gpu::CommandRecorder& recorder, const Batch& batch, const gpu::Buffer& cameras) {
    batch_ = batch;
    const std::uint32_t tiles = gpu::groups_for(batch.width, shared::kHoleTileWidth) *
                                gpu::groups_for(batch.height, shared::kHoleTileHeight);
    word_count_ = tiles * batch.view_count;
    HoleHistory::Frame& frame = batch_.history->now();
    grow(device_, frame.cameras, cameras.size_bytes());
    grow(device_, frame.words, 4ULL * word_count_);
    grow(device_, frame.first, 4ULL * word_count_);
    grow(device_, frame.pixels, 4ULL * view_stride(batch.width, batch.height) * batch.view_count);
    grow(device_, blocks_, 4ULL * gpu::groups_for(word_count_, shared::kHoleBlock));
    recorder.copy(cameras, frame.cameras, cameras.size_bytes());
    recorder.fill(frame.words, 0);
}

void HoleFiller::number_holes(gpu::CommandRecorder& recorder, const gpu::Buffer& counters) {
    const HoleHistory::Frame& frame = batch_.history->now();
    const std::uint32_t block_count = gpu::groups_for(word_count_, shared::kHoleBlock);
    const shared::HoleMapParams params{frame.words.address(), frame.first.address(), blocks_.address(),
                                       frame.pixels.address(), counters.address(),    word_count_,
                                       block_count,            batch_.width,          batch_.height};
    recorder.stage("number_holes");
    recorder.dispatch(count_, {}, params, linear_groups(block_count));
    recorder.barrier();
    recorder.dispatch(scan_, {}, params, {1, 1, 1});
    recorder.barrier();
    recorder.dispatch(list_, {}, params, linear_groups(block_count));
    recorder.barrier();
}

void HoleFiller::reserve(std::uint32_t hole_count) {
    hole_count_ = hole_count;
    HoleHistory::Frame& frame = batch_.history->now();
    grow(device_, frame.surfaces, 16ULL * hole_count);
    grow(device_, frame.light, 16ULL * hole_count);
    grow(device_, filtered_, 16ULL * hole_count);
    grow(device_, lists_, 3 * 4ULL * hole_count);
    const std::array records{frame.record(), batch_.history->before().record()};
    gpu::write_buffer(device_, frame_records_, std::as_bytes(std::span(records)));
}

shared::HoleParams HoleFiller::make_params(const FrameHeader& header, const Targets& targets) const {
    const RenderSettings& settings = header.settings;
    const HoleFilling holes = hole_filling(header);
    shared::HoleParams params{};
    params.frames = frame_records_.address();
    params.visibility = targets.visibility.address();
    params.views = targets.views.address();
    params.counters = targets.counters.address();
    params.lists = lists_.address();
    params.light_in = batch_.history->now().light.address();
    params.light_out = filtered_.address();
    params.radiance = targets.radiance.address();
    params.width = batch_.width;
    params.height = batch_.height;
    params.hole_count = hole_count_;
    params.stages = (holes.previous_frame && batch_.has_history ? shared::kHolesPreviousFrame : 0U) |
                    (holes.isolated ? shared::kHolesIsolated : 0U) |
                    (holes.end_in_source ? shared::kHolesEndInSource : 0U) |
                    (batch_.corners.empty() ? 0U : shared::kHolesCascade);
    params.noise_frame = header.noise_frame;
    params.samples_per_pixel = settings.samples_per_pixel;
    params.path = path_bits(settings);
    params.max_indirect = max_indirect(header);
    params.alpha = least_weight(header);
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t corner = i < batch_.corners.size() ? batch_.corners[i] : shared::kNoCornerView;
        params.corner_views |= corner << (8 * i);
    }
    params.settings = reproject_settings(header);
    return params;
}

void HoleFiller::trace_list(gpu::CommandRecorder& recorder, const Targets& targets, shared::HoleParams params,
                            std::uint32_t list) {
    params.list = list;
    recorder.stage("holes");
    recorder.dispatch(finish_, {},
                      shared::FinishListParams{targets.counters.address(), list, shared::kLinearGroup}, {1, 1, 1});
    recorder.barrier();
    recorder.dispatch_indirect(trace_, {&scene_.bindings(), &targets.source_set}, params, targets.counters,
                               (list + 1) * 4);
    recorder.barrier();
}

void HoleFiller::keep(gpu::CommandRecorder& recorder, const shared::ViewLight& light,
                      const shared::HoleParams& params) const {
    shared::KeepHolesParams kept{};
    kept.frame = batch_.history->now().record();
    kept.light_in = params.light_in;
    kept.diffuse = light.diffuse;
    kept.specular = light.specular;
    kept.width = params.width;
    kept.height = params.height;
    kept.hole_count = params.hole_count;
    recorder.stage("keep_holes");
    recorder.dispatch(keep_, {}, kept, linear_groups(hole_count_));
    recorder.barrier();
}

void HoleFiller::smooth_and_shade(gpu::CommandRecorder& recorder, const FrameHeader& header, const Targets& targets,
                                  shared::HoleParams params) {
    const std::initializer_list<const gpu::BindingSet*> sets{&scene_.bindings(), &targets.source_set};
    if (hole_filling(header).denoise) {
        recorder.stage("denoise_holes");
        recorder.dispatch(filter_, sets, params, linear_groups(hole_count_));
        recorder.barrier();
        params.light_in = filtered_.address();
    }
    if (targets.light != nullptr) {
        keep(recorder, *targets.light, params);
        return;
    }
    recorder.stage("shade_holes");
    recorder.dispatch(shade_, sets, params, linear_groups(hole_count_));
    recorder.barrier();
}

void HoleFiller::fill(gpu::CommandRecorder& recorder, const FrameHeader& header, const Targets& targets,
                      std::vector<StageTime>& times) {
    number_holes(recorder, targets.counters);
    recorder.submit();
    append_times(recorder, times);
    reserve(gpu::read_buffer_as<std::uint32_t>(device_, targets.counters, 1, shared::kCounterHoles * 4ULL).front());
    if (hole_count_ == 0) {
        return;
    }
    const shared::HoleParams params = make_params(header, targets);
    const std::initializer_list<const gpu::BindingSet*> sets{&scene_.bindings(), &targets.source_set};
    recorder.stage("start_holes");
    recorder.dispatch(start_, sets, params, linear_groups(hole_count_));
    recorder.barrier();
    trace_list(recorder, targets, params, shared::kCounterFirstHoles);
    if (!batch_.corners.empty()) {
        recorder.stage("cascade_holes");
        recorder.dispatch(finish_, {},
                          shared::FinishListParams{params.counters, shared::kCounterInnerHoles, shared::kLinearGroup},
                          {1, 1, 1});
        recorder.barrier();
        recorder.dispatch_indirect(cascade_, sets, params, targets.counters, (shared::kCounterInnerHoles + 1) * 4);
        recorder.barrier();
        trace_list(recorder, targets, params, shared::kCounterRestHoles);
    }
    smooth_and_shade(recorder, header, targets, params);
}

std::vector<bool> HoleFiller::mask(std::uint32_t view) const {
    const std::uint32_t tile_cols = gpu::groups_for(batch_.width, shared::kHoleTileWidth);
    const std::uint64_t words_per_view = word_count_ / batch_.view_count;
    const auto words = gpu::read_buffer_as<std::uint32_t>(device_, map(), words_per_view,
                                                          4 * words_per_view * view);
    std::vector<bool> holes;
    holes.reserve(static_cast<std::size_t>(batch_.width) * batch_.height);
    for (std::uint32_t y = 0; y < batch_.height; ++y) {
        for (std::uint32_t x = 0; x < batch_.width; ++x) {
            const std::uint32_t word = words[y / shared::kHoleTileHeight * tile_cols + x / shared::kHoleTileWidth];
            const std::uint32_t bit = y % shared::kHoleTileHeight * shared::kHoleTileWidth + x % shared::kHoleTileWidth;
            holes.push_back((word >> bit & 1U) != 0);
        }
    }
    return holes;
}

HoleCounts HoleFiller::counts(const std::vector<std::uint32_t>& counters) {
    HoleCounts counts;
    counts.holes = counters[shared::kCounterHoles];
    counts.remembered = counters[shared::kCounterRememberedHoles];
    counts.isolated = counters[shared::kCounterIsolatedHoles];
    counts.cascaded = counters[shared::kCounterInnerHoles] - counters[shared::kCounterRestHoles];
    counts.traced = counters[shared::kCounterFirstHoles] + counters[shared::kCounterRestHoles];
    return counts;
}

} // namespace fieldcast::render
