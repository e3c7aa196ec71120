// SPDX-License-Identifier: Apache-2.0
#include "core/render/warp/warp_renderer.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "core/render/warp/warp_images.h"

namespace fieldcast::render {

struct WarpRenderer::State {
    explicit State(const gpu::Device& d)
        : device(d), recorder(d), images(d),
          search(make_plain_kernel(d, KernelId::kWarpViews, sizeof(shared::WarpViewsParams), {&images.layout()})),
          fill(make_plain_kernel(d, KernelId::kWarpFill, sizeof(shared::WarpViewsParams), {&images.layout()})) {}

    std::uint32_t view_count() const { return static_cast<std::uint32_t>(request.positions.size()); }
    void resize();
    void upload_paths();
    void record();
    Views download(const FrameHeader& header);

    const gpu::Device& device;
    gpu::CommandRecorder recorder;
    WarpImages images;
    gpu::Kernel search;
    gpu::Kernel fill;
    ViewRequest request;
    std::vector<WarpCounts> counts;
    std::uint64_t reserved_pixels = 0; ///< pixels of all views, padded, that the buffers hold
    gpu::Buffer paths;
    gpu::Buffer counters;
    gpu::Buffer pixels;
    gpu::Buffer inverse_depth;
    gpu::Buffer rgb8;
};

void WarpRenderer::State::resize() {
    paths = gpu::Buffer(device, std::uint64_t{view_count()} * images.image_count() * sizeof(shared::WarpPath));
    counters = gpu::Buffer(device, std::uint64_t{view_count()} * shared::kWarpCounters * 4);
    const std::uint64_t wanted = std::uint64_t{view_stride(request)} * view_count();
    if (wanted > reserved_pixels) {
        reserved_pixels = wanted;
        pixels = gpu::Buffer(device, wanted * 4);
        inverse_depth = gpu::Buffer(device, wanted * 4);
        rgb8 = gpu::Buffer(device, wanted * 3);
    }
}

void WarpRenderer::State::upload_paths() {
    std::vector<shared::WarpPath> records;
    for (const LatticePosition position : request.positions) {
        const Camera camera = view_camera(images.header().source, request.geometry, position, request.fovy_rad,
                                          request.width_px, request.height_px);
        for (std::uint32_t image = 0; image < images.image_count(); ++image) {
            records.push_back(images.path(image, camera));
        }
    }
    gpu::write_buffer(device, paths, std::as_bytes(std::span(records)));
}

void WarpRenderer::State::record() {
    shared::WarpViewsParams params{};
    params.images = images.records().address();
    params.paths = paths.address();
    params.pixels = pixels.address();
    params.inverse_depth = inverse_depth.address();
    params.counters = counters.address();
    params.rgb8 = rgb8.address();
    params.width = request.width_px;
    params.height = request.height_px;
    params.view_count = view_count();
    params.image_count = images.image_count();
    recorder.fill(counters, 0);
    recorder.barrier();
    recorder.stage("warp_search");
    recorder.dispatch(search, {&images.bindings()}, params,
                      {gpu::groups_for(params.width, 8), gpu::groups_for(params.height, 8), params.view_count});
    recorder.barrier();
    recorder.stage("warp_fill");
    recorder.dispatch(fill, {&images.bindings()}, params, linear_groups(view_stride(request) / 4 * view_count()));
    recorder.barrier();
}

Views WarpRenderer::State::download(const FrameHeader& header) {
    const std::size_t count = request.positions.size() * shared::kWarpCounters;
    const auto values = gpu::read_buffer_as<std::uint32_t>(device, counters, count);
    Views result{header, {}};
    counts.clear();
    for (std::size_t i = 0; i < request.positions.size(); ++i) {
        const std::uint32_t* const of_view = &values[i * shared::kWarpCounters];
        counts.push_back({.residual = of_view[shared::kWarpCountResidual],
                          .outside = of_view[shared::kWarpCountOutside],
                          .hidden = of_view[shared::kWarpCountHidden]});
        Plane image{PlaneSemantic::kColour, PlaneFormat::kRgb8, request.width_px, request.height_px, {}};
        image.bytes.resize(plane_bytes(image.format, image.width_px, image.height_px));
        gpu::read_buffer(device, rgb8, image.bytes, 3ULL * view_stride(request) * i);
        const DiscardCounts discards{.out_of_frustum = counts.back().outside, .plane = counts.back().hidden};
        result.views.push_back({request.positions[i], std::move(image), discards});
    }
    return result;
}

WarpRenderer::WarpRenderer(const gpu::Device& device) : state_(std::make_unique<State>(device)) {}

WarpRenderer::~WarpRenderer() = default;

Decoded<void> WarpRenderer::upload(const SourceFrame& frame) {
    return state_->images.upload(frame);
}

Views WarpRenderer::render(const ViewRequest& request) {
    State& s = *state_;
    FC_ASSERT(s.images.image_count() > 0, "render() needs upload() first");
    FC_ASSERT(!request.positions.empty() && request.width_px > 0 && request.height_px > 0, "the request has no pixels");
    s.request = request;
    s.resize();
    s.upload_paths();
    s.record();
    s.recorder.submit();
    FrameHeader header = s.images.header();
    append_times(s.recorder, header.render_times);
    return s.download(header);
}

const std::vector<WarpCounts>& WarpRenderer::counts() const {
    return state_->counts;
}

std::vector<bool> WarpRenderer::hole_mask(std::size_t index) const {
    const State& s = *state_;
    FC_ASSERT(index < s.request.positions.size(), "no such view");
    const std::size_t count = std::size_t{s.request.width_px} * s.request.height_px;
    const auto words =
        gpu::read_buffer_as<std::uint32_t>(s.device, s.pixels, count, 4ULL * view_stride(s.request) * index);
    std::vector<bool> mask(count);
    for (std::size_t i = 0; i < count; ++i) {
        mask[i] = (words[i] & shared::kWarpHole) != 0;
    }
    return mask;
}

} // namespace fieldcast::render
