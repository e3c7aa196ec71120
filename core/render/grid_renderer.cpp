// SPDX-License-Identifier: Apache-2.0
#include "core/render/grid_renderer.h"

#include "core/render/camera_record.h"
#include "core/render/corner_views.h"
#include "core/render/frame_parameters.h"
#include "core/render/hole_filler.h"
#include "core/render/kernels.h"
#include "core/render/reflections.h"
#include "core/render/view_history.h"
#include "core/render/view_visibility.h"
#include "core/render/visibility_depth.h"

#include <glm/gtc/packing.hpp>

namespace fieldcast::render {

namespace {

Camera request_camera(const Camera& source, const ViewRequest& request, LatticePosition position) {
    const GuardBand& band = request.guard_band;
    const Camera inner = view_camera(source, request.geometry, position, request.fovy_rad,
                                     request.width_px - band.left_px - band.right_px,
                                     request.height_px - band.top_px - band.bottom_px);
    return with_guard_band(inner, band);
}

} // namespace

struct GridRenderer::State {
    State(const gpu::Device& d, const scene::GpuScene& s);

    void resize(const SourcePlanes& source);
    void upload_cameras(const SourcePlanes& source, const std::vector<std::uint32_t>& corners);
    void record_visibility();
    void record_interleave(const SourcePlanes& source);
    void record_reproject(const FrameHeader& header);
    /// Filters over views know nothing of rays that were looked up for one view.
    bool wants_reflections(const FrameHeader& header) const {
        return filter == nullptr && reflections.are_wanted(header);
    }
    shared::TraceListParams list_params(const FrameHeader& header) const;
    void record_holes(FrameHeader& header);
    void record_layers(const FrameHeader& header);
    HoleFiller::Batch make_batch(const FrameHeader& header, const ViewRequest& asked);
    void begin_filter(const FrameHeader& header);
    void record_tone_map(const FrameHeader& header);
    Views download(const FrameHeader& header, const std::vector<std::uint32_t>& counts) const;
    DiscardCounts discards(const std::vector<std::uint32_t>& values, std::size_t view) const;
    std::vector<glm::uvec2> download_visibility(std::size_t view) const;
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(request.positions.size()); }

    const gpu::Device& device;
    const scene::GpuScene& scene;
    gpu::Recorder recorder;
    gpu::BindingLayout source_layout;
    ViewVisibility view_visibility;
    gpu::Kernel interleave_kernel;
    gpu::Kernel reproject_kernel;
    gpu::Kernel finish_kernel;
    gpu::Kernel layers_kernel;
    gpu::Kernel tone_map_kernel;

    HoleFiller filler;
    Reflections reflections;

    ViewRequest request;    ///< with the corner views of the hole cascade
    std::size_t wanted = 0; ///< views that were asked for; they come first
    ViewHistories histories;
    ViewFilter* filter = nullptr; ///< of this frame's views; null: they are not filtered
    HoleCounts hole_counts;
    std::vector<Camera> view_cameras;
    std::uint32_t source_texels = 0; ///< of all pages
    std::uint64_t view_pixels = 0; ///< over all views, padded
    std::uint64_t invalid_samples = 0;

    gpu::Buffer geometry; ///< of the source, interleaved
    gpu::Buffer illumination;
    gpu::TexelView geometry_view;
    gpu::TexelView illumination_view;
    gpu::BindingSet source_set;

    gpu::Buffer cameras; ///< kMaxSources of sources, then of the views
    gpu::Buffer views;   ///< ViewRecord
    gpu::Buffer counters;
    gpu::Buffer visibility;
    gpu::Buffer layers;
    gpu::Buffer radiance;
    gpu::Buffer layer_pixels;
    gpu::Buffer rgb8;
};

GridRenderer::State::State(const gpu::Device& d, const scene::GpuScene& s)
    : device(d), scene(s), recorder(d),
      source_layout(d, {{shared::kReprojectGeometry, gpu::BindingType::kTexelBuffer, 1},
                        {shared::kReprojectIllumination, gpu::BindingType::kTexelBuffer, 1}}),
      view_visibility(d, s),
      interleave_kernel(make_plain_kernel(d, KernelId::kInterleaveSource, sizeof(shared::InterleaveParams))),
      reproject_kernel(
          make_scene_kernel(d, s, KernelId::kReproject, sizeof(shared::ReprojectParams), {&source_layout})),
      finish_kernel(make_plain_kernel(d, KernelId::kFinishList, sizeof(shared::FinishListParams))),
      layers_kernel(
          make_scene_kernel(d, s, KernelId::kCompositeLayers, sizeof(shared::TraceListParams), {&source_layout})),
      tone_map_kernel(make_plain_kernel(d, KernelId::kToneMap, sizeof(shared::ToneMapParams))),
      filler(d, s, source_layout), reflections(d, s, source_layout), histories(d, s) {}

HoleFiller::Batch GridRenderer::State::make_batch(const FrameHeader& header, const ViewRequest& asked) {
    wanted = asked.positions.size();
    ViewRequest next = asked;
    HoleFiller::Batch batch{.width = asked.width_px, .height = asked.height_px};
    batch.corners = choose_corners(hole_filling(header), next.positions);
    batch.view_count = static_cast<std::uint32_t>(next.positions.size());
    if (ViewFilter::is_wanted(header)) {
        ViewFilter::check(device, header.settings, next);
    }
    request = std::move(next);
    HistoryOfHoles& history = histories.holes(request);
    batch.history = &history.holes;
    batch.has_history = !header.cut && header.still_frames != 1 && history.pose_count > 0 &&
                        history.pose_count + 1 == scene.pose_count();
    history.holes.current = 1 - history.holes.current;
    history.pose_count = scene.pose_count();
    return batch;
}

void GridRenderer::State::resize(const SourcePlanes& source) {
    if (source.texel_count() != source_texels) {
        source_texels = source.texel_count();
        geometry = gpu::Buffer(device, static_cast<std::uint64_t>(source_texels) * 16);
        illumination = gpu::Buffer(device, static_cast<std::uint64_t>(source_texels) * 8);
        geometry_view = gpu::TexelView(device, geometry, VK_FORMAT_R32G32B32A32_UINT);
        illumination_view = gpu::TexelView(device, illumination, VK_FORMAT_R32G32_UINT);
        source_set = gpu::BindingSet(device, source_layout);
        source_set.set(shared::kReprojectGeometry, geometry_view);
        source_set.set(shared::kReprojectIllumination, illumination_view);
    }
    cameras = gpu::Buffer(device, (shared::kMaxSources + view_count()) * sizeof(shared::CameraRecord));
    views = gpu::Buffer(device, view_count() * sizeof(shared::ViewRecord));
    counters = gpu::Buffer(device, (shared::kCounterDiscards + 4ULL * view_count()) * 4);
    const std::uint64_t pixels = std::uint64_t{view_stride(request)} * view_count();
    if (pixels <= view_pixels) {
        return;
    }
    view_pixels = pixels;
    visibility = gpu::Buffer(device, pixels * 8);
    layers = gpu::Buffer(device, scene.has_blend() ? pixels * 16 : 16);
    radiance = gpu::Buffer(device, pixels * 8);
    layer_pixels = gpu::Buffer(device, scene.has_blend() ? pixels * 4 : 16);
    rgb8 = gpu::Buffer(device, pixels * 3);
    reflections.resize(pixels);
}

void GridRenderer::State::upload_cameras(const SourcePlanes& source, const std::vector<std::uint32_t>& corners) {
    const FrameHeader& header = source.header();
    std::vector<shared::CameraRecord> camera_records(shared::kMaxSources);
    for (std::uint32_t i = 0; i < source.source_count(); ++i) {
        camera_records[i] = make_camera_record(source.camera(i));
    }
    std::vector<shared::ViewRecord> view_records;
    view_cameras.clear();
    for (const LatticePosition position : request.positions) {
        view_cameras.push_back(request_camera(header.source, request, position));
        camera_records.push_back(make_camera_record(view_cameras.back()));
        view_records.push_back({view_seed(header, position), 0U});
    }
    for (const std::uint32_t corner : corners) {
        view_records[corner].is_corner = 1;
    }
    gpu::write_buffer(device, cameras, std::as_bytes(std::span(camera_records)));
    gpu::write_buffer(device, views, std::as_bytes(std::span(view_records)));
}

void GridRenderer::State::begin_filter(const FrameHeader& header) {
    filter = ViewFilter::is_wanted(header) ? &histories.filter(request) : nullptr;
    if (filter != nullptr) {
        filter->begin(header, request, make_camera_records(view_cameras));
    }
}

void GridRenderer::State::record_visibility() {
    recorder.stage("views_visibility");
    const std::uint64_t records = cameras.address() + shared::kMaxSources * sizeof(shared::CameraRecord);
    view_visibility.record(recorder, {view_cameras, records, &visibility, &layers});
}

void GridRenderer::State::record_interleave(const SourcePlanes& source) {
    shared::InterleaveParams params{};
    params.diffuse = source.plane(PlaneSemantic::kDiffuse).address();
    params.specular = source.plane(PlaneSemantic::kSpecular).address();
    params.depth = source.plane(PlaneSemantic::kDepth).address();
    params.normal = source.plane(PlaneSemantic::kNormal).address();
    params.id = source.plane(PlaneSemantic::kId).address();
    params.material = source.plane(PlaneSemantic::kMaterial).address();
    params.geometry = geometry.address();
    params.illumination = illumination.address();
    params.pixel_count = source.texel_count();
    recorder.stage("interleave");
    recorder.dispatch(interleave_kernel, {}, params, linear_groups(params.pixel_count));
    recorder.barrier();
}

void GridRenderer::State::record_reproject(const FrameHeader& header) {
    shared::ReprojectParams params{};
    params.cameras = cameras.address();
    params.visibility = visibility.address();
    params.layers = layers.address();
    params.radiance = radiance.address();
    params.holes = filler.map().address();
    params.layer_pixels = layer_pixels.address();
    params.glossy_pixels = reflections.pixels().address();
    params.flags = (wants_reflections(header) ? shared::kFlagReflections : 0) |
                   (filter != nullptr ? shared::kFlagKeepLight : 0);
    params.counters = counters.address();
    if (filter != nullptr) {
        params.light = filter->light();
    }
    params.width = request.width_px;
    params.height = request.height_px;
    params.view_count = view_count();
    params.settings = reproject_settings(header);
    recorder.stage("reproject");
    recorder.dispatch(reproject_kernel, {&scene.bindings(), &source_set}, params,
                      {gpu::groups_for(params.width, shared::kLinearGroup), params.height, params.view_count});
    recorder.barrier();
}

// The header gets the times of the stages so far.
void GridRenderer::State::record_holes(FrameHeader& header) {
    const shared::ViewLight light = filter != nullptr ? filter->light() : shared::ViewLight{};
    filler.fill(recorder, header,
                {visibility, views, counters, radiance, source_set, filter != nullptr ? &light : nullptr},
                header.render_times);
}

// For kernels that go through a compacted list over all views.
shared::TraceListParams GridRenderer::State::list_params(const FrameHeader& header) const {
    shared::TraceListParams params{};
    params.cameras = cameras.address();
    params.visibility = visibility.address();
    params.layers = layers.address();
    params.radiance = radiance.address();
    params.counters = counters.address();
    params.views = views.address();
    params.width = request.width_px;
    params.height = request.height_px;
    params.samples_per_pixel = header.settings.samples_per_pixel;
    params.path = path_bits(header.settings);
    params.max_indirect = max_indirect(header);
    params.layer_count = header.layer_count;
    params.settings = reproject_settings(header);
    return params;
}

void GridRenderer::State::record_layers(const FrameHeader& header) {
    shared::TraceListParams params = list_params(header);
    params.list = layer_pixels.address();
    recorder.stage("layers");
    recorder.dispatch(finish_kernel, {},
                      shared::FinishListParams{counters.address(), shared::kCounterLayers, shared::kLinearGroup},
                      {1, 1, 1});
    recorder.barrier();
    recorder.dispatch_indirect(layers_kernel, {&scene.bindings(), &source_set}, params, counters,
                               (shared::kCounterLayers + 1) * 4);
    recorder.barrier();
}

void GridRenderer::State::record_tone_map(const FrameHeader& header) {
    shared::ToneMapParams params{};
    params.radiance = radiance.address();
    params.rgb8 = rgb8.address();
    params.pixel_count = view_stride(request) * view_count();
    params.flags = kernel_flags(header.settings);
    params.exposure = header.settings.exposure;
    recorder.stage("tone_map");
    recorder.dispatch(tone_map_kernel, {}, params, linear_groups(params.pixel_count / 4));
    recorder.barrier();
}

DiscardCounts GridRenderer::State::discards(const std::vector<std::uint32_t>& values, std::size_t view) const {
    const std::size_t base = shared::kCounterDiscards + 4 * view;
    return {values[base + shared::kDiscardFrustum], values[base + shared::kDiscardId],
            values[base + shared::kDiscardPlane], values[base + shared::kDiscardNormal]};
}

Views GridRenderer::State::download(const FrameHeader& header, const std::vector<std::uint32_t>& counts) const {
    Views result{header, {}};
    result.views.reserve(wanted);
    for (std::size_t i = 0; i < wanted; ++i) {
        Plane image{PlaneSemantic::kColour, PlaneFormat::kRgb8, request.width_px, request.height_px, {}};
        image.bytes.resize(plane_bytes(image.format, image.width_px, image.height_px));
        gpu::read_buffer(device, rgb8, image.bytes, 3ULL * view_stride(request) * i);
        result.views.push_back({request.positions[i], std::move(image), discards(counts, i)});
    }
    return result;
}

/// (instance, primitive) of each pixel.
std::vector<glm::uvec2> GridRenderer::State::download_visibility(std::size_t view) const {
    FC_ASSERT(view < wanted, "no such view");
    const std::size_t count = static_cast<std::size_t>(request.width_px) * request.height_px;
    return gpu::read_buffer_as<glm::uvec2>(device, visibility, count, 8ULL * view_stride(request) * view);
}

GridRenderer::GridRenderer(const gpu::Device& device, const scene::GpuScene& scene)
    : state_(std::make_unique<State>(device, scene)) {}

GridRenderer::~GridRenderer() = default;

Views GridRenderer::render(const SourcePlanes& source, const ViewRequest& request) {
    FC_ASSERT(!request.positions.empty() && request.width_px > 0 && request.height_px > 0, "nothing to render");
    State& s = *state_;
    FrameHeader header = source.header();
    const HoleFiller::Batch batch = s.make_batch(header, request);
    s.resize(source);
    s.upload_cameras(source, batch.corners);
    s.begin_filter(header);

    s.recorder.fill(s.counters, 0);
    s.filler.begin(s.recorder, batch, s.cameras);
    s.recorder.barrier();
    s.record_visibility();
    s.record_interleave(source);
    s.record_reproject(header);
    s.record_holes(header);
    if (s.wants_reflections(header)) {
        s.reflections.record(s.recorder, s.list_params(header), s.counters, s.source_set);
    }
    if (s.filter != nullptr) {
        s.filter->record(s.recorder, header, {s.visibility, s.layers, s.radiance});
    }
    if (s.scene.has_blend()) {
        s.record_layers(header);
    }
    s.record_tone_map(header);
    s.recorder.submit();
    if (s.filter != nullptr) {
        s.filter->end();
    }

    append_times(s.recorder, header.render_times);
    const auto counts = gpu::read_buffer_as<std::uint32_t>(s.device, s.counters, s.counters.size_bytes() / 4);
    s.invalid_samples += counts[shared::kCounterInvalidSamples];
    s.hole_counts = HoleFiller::counts(counts);
    return s.download(header, counts);
}

LinearView GridRenderer::linear_view(std::size_t index) const {
    const State& s = *state_;
    FC_ASSERT(index < s.wanted, "no such view");
    const std::size_t count = static_cast<std::size_t>(s.request.width_px) * s.request.height_px;
    const auto texels = gpu::read_buffer_as<glm::uvec2>(s.device, s.radiance, count,
                                                        8ULL * view_stride(s.request) * index);
    LinearView view{s.request.width_px, s.request.height_px, {}};
    view.pixels.reserve(count);
    for (const glm::uvec2 texel : texels) {
        const glm::vec2 rg = glm::unpackHalf2x16(texel.x);
        view.pixels.emplace_back(rg.x, rg.y, glm::unpackHalf2x16(texel.y).x);
    }
    return view;
}

std::vector<float> GridRenderer::view_depth(std::size_t index) const {
    return depth_of_visibility(state_->scene, state_->view_cameras.at(index), state_->download_visibility(index));
}

std::vector<std::uint32_t> GridRenderer::view_instances(std::size_t index) const {
    std::vector<std::uint32_t> instances;
    for (const glm::uvec2 seen : state_->download_visibility(index)) {
        instances.push_back(seen.x); // shared::kNoInstance is scene::kNone
    }
    return instances;
}

std::vector<bool> GridRenderer::hole_mask(std::size_t index) const {
    const State& s = *state_;
    FC_ASSERT(index < s.wanted, "no such view");
    return s.filler.mask(static_cast<std::uint32_t>(index));
}

HoleCounts GridRenderer::hole_counts() const {
    return state_->hole_counts;
}

std::uint64_t GridRenderer::invalid_sample_count() const {
    return state_->invalid_samples;
}

} // namespace fieldcast::render
