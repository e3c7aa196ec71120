// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/view_filter.h"

#include "core/base/error.h"
#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "shaders/shared/bmfr.h"

#include <algorithm>

namespace fieldcast::render {

namespace {

// Bytes per pixel. Accumulation keeps geometry, two colours, moments and length of this and the previous frame, and two
// noisy colours. Each denoiser adds two pairs of colours. BMFR adds taps and one fit per block; a view has one block
// more in each direction than fits into it, which is counted as two blocks per 32×32 pixels.
constexpr std::uint64_t kBytesToAccumulate = 2 * (16 + 2 * 16 + 16 + 4) + 2 * 16;
constexpr std::uint64_t kBytesToDenoise = 2 * 2 * 16;
constexpr std::uint64_t kBytesToFit = sizeof(shared::HistoryTaps) + (2 * sizeof(shared::BlockFit) + 1023) / 1024;

} // namespace

std::uint64_t ViewFilter::bytes_per_pixel(const RenderSettings& settings) {
    const bool denoises = settings.denoised_images == DenoisedImages::kViews && settings.denoiser != Denoiser::kNone;
    return kBytesToAccumulate + (denoises ? kBytesToDenoise : 0) +
           (denoises && settings.denoiser == Denoiser::kBmfr ? kBytesToFit : 0);
}

ViewFilter::ViewFilter(const gpu::Device& device, const scene::GpuScene& scene)
    : device_(device), scene_(scene), filter_(device, scene), groups_(device),
      shade_(make_scene_kernel(device, scene, KernelId::kShadeViews, sizeof(shared::ShadeViewsParams))) {}

bool ViewFilter::is_wanted(const FrameHeader& header) {
    return filters_views(header);
}

std::uint64_t ViewFilter::max_pixels(const gpu::Device& device, const RenderSettings& settings) {
    return std::min<std::uint64_t>(device.info().max_texel_buffer_elements,
                                   device.info().memory_bytes / bytes_per_pixel(settings));
}

void ViewFilter::check(const gpu::Device& device, const RenderSettings& settings, const ViewRequest& request) {
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(request.width_px) * request.height_px * request.positions.size();
    const std::uint64_t most = max_pixels(device, settings);
    if (pixels > most) {
        throw UserError(std::to_string(request.positions.size()) + " views of " + std::to_string(request.width_px) +
                        "x" + std::to_string(request.height_px) + " are too many for " + device.info().name +
                        " to average or denoise each: it has room for " + std::to_string(most) +
                        " pixels; take fewer or smaller views, or denoise the source and do not average views");
    }
}

void ViewFilter::begin(const FrameHeader& header, const ViewRequest& request,
                       std::span<const shared::CameraRecord> cameras) {
    const bool follows = pose_count_ > 0 && pose_count_ + 1 == scene_.pose_count() && request == request_;
    has_history_ = follows && !header.cut;
    std::vector<shared::CameraRecord> records(cameras.begin(), cameras.end());
    const std::vector<shared::CameraRecord> before = follows ? std::move(records_) : records;
    records_ = records;
    records.insert(records.end(), before.begin(), before.end());
    const std::uint64_t bytes = records.size() * sizeof(shared::CameraRecord);
    if (!cameras_ || cameras_.size_bytes() < bytes) {
        cameras_ = gpu::Buffer(device_, bytes);
    }
    gpu::write_buffer(device_, cameras_, std::as_bytes(std::span(records)));
    request_ = request;
    pose_count_ = scene_.pose_count();
    filter_.resize(texel_count());
    if (groups_.resize(gpu::groups_for(texel_count(), shared::kLinearGroup))) {
        groups_.list_all();
    }
}

shared::ViewLight ViewFilter::light() const {
    return {filter_.geometry().address(), filter_.noisy_diffuse().address(), filter_.noisy_specular().address()};
}

// If the light was denoised in the source, views are averaged only.
FilterFrame ViewFilter::make_frame(const FrameHeader& header, const Targets& targets) const {
    FilterFrame frame{.cameras = cameras_.address(),
                      .visibility = targets.visibility.address(),
                      .layers = targets.layers.address(),
                      .groups = &groups_,
                      .width = request_.width_px,
                      .height = request_.height_px,
                      .page_count = view_count(),
                      .source_count = view_count(),
                      .has_history = has_history_,
                      .least_weight = least_weight(header),
                      .number = header.noise_frame,
                      .settings = header.settings};
    if (denoises_views(header)) {
        frame.has_history = has_history_ && header.settings.temporal_accumulation;
    } else {
        frame.settings.denoiser = Denoiser::kNone;
        frame.settings.temporal_accumulation = true;
    }
    return frame;
}

void ViewFilter::record(gpu::CommandRecorder& recorder, const FrameHeader& header, const Targets& targets) {
    filter_.record(recorder, make_frame(header, targets));
    shared::ShadeViewsParams params{};
    params.cameras = cameras_.address();
    params.visibility = targets.visibility.address();
    params.radiance = targets.radiance.address();
    params.diffuse = filter_.diffuse().address();
    params.specular = filter_.specular().address();
    params.width = request_.width_px;
    params.height = request_.height_px;
    params.view_count = view_count();
    recorder.stage("shade_views");
    recorder.dispatch(shade_, {&scene_.bindings()}, params, linear_groups(texel_count()));
    recorder.barrier();
}

} // namespace fieldcast::render
