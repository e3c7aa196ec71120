// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/grid_renderer.h"

#include "core/render/camera_record.h"
#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "core/render/views/corner_views.h"
#include "core/render/views/grid_renderer_state.h"

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

GridRendererState::GridRendererState(const gpu::Device& d, const scene::GpuScene& s)
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
      filler(d, s, source_layout), reflections(d, s, source_layout), readback(d), histories(d, s) {}

HoleFiller::Batch GridRendererState::make_batch(const FrameHeader& header, const ViewRequest& asked) {
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

void GridRendererState::resize(const SourcePlanes& source) {
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
    gpu::make_room(device, cameras, (shared::kMaxSources + view_count()) * sizeof(shared::CameraRecord));
    gpu::make_room(device, views, view_count() * sizeof(shared::ViewRecord));
    gpu::make_room(device, counters, counter_count() * sizeof(std::uint32_t));
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

void GridRendererState::place_views(const Camera& source) {
    view_cameras.clear();
    for (const LatticePosition position : request.positions) {
        view_cameras.push_back(request_camera(source, request, position));
    }
}

void GridRendererState::record_cameras(const SourcePlanes& source, const std::vector<std::uint32_t>& corners) {
    std::vector<shared::CameraRecord> camera_records(shared::kMaxSources);
    for (std::uint32_t i = 0; i < source.source_count(); ++i) {
        camera_records[i] = make_camera_record(source.camera(i));
    }
    std::vector<shared::ViewRecord> view_records;
    for (std::size_t i = 0; i < request.positions.size(); ++i) {
        camera_records.push_back(make_camera_record(view_cameras[i]));
        view_records.push_back({view_seed(source.header(), request.positions[i]), 0U});
    }
    for (const std::uint32_t corner : corners) {
        view_records[corner].is_corner = 1;
    }
    recorder.update(cameras, std::as_bytes(std::span(camera_records)));
    recorder.update(views, std::as_bytes(std::span(view_records)));
}

void GridRendererState::begin_filter(const FrameHeader& header) {
    filter = ViewFilter::is_wanted(header) ? &histories.filter(request) : nullptr;
    if (filter != nullptr) {
        filter->begin(header, request, make_camera_records(view_cameras));
    }
}

void GridRendererState::record_visibility() {
    recorder.stage("views_visibility");
    const std::uint64_t records = cameras.address() + shared::kMaxSources * sizeof(shared::CameraRecord);
    view_visibility.record(recorder, {view_cameras, records, &visibility, &layers});
}

void GridRendererState::record_interleave(const SourcePlanes& source) {
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

void GridRendererState::record_reproject(const FrameHeader& header) {
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

// Appends the times of the stages so far to the header.
void GridRendererState::record_holes(FrameHeader& header) {
    const shared::ViewLight light = filter != nullptr ? filter->light() : shared::ViewLight{};
    filler.fill(recorder, header,
                {visibility, views, counters, radiance, source_set, filter != nullptr ? &light : nullptr},
                header.render_times);
}

// Parameters of kernels that process a compacted list of pixels of all views.
shared::TraceListParams GridRendererState::list_params(const FrameHeader& header) const {
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

void GridRendererState::record_layers(const FrameHeader& header) {
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

void GridRendererState::record_tone_map(const FrameHeader& header) {
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

DiscardCounts GridRendererState::discards(const std::vector<std::uint32_t>& values, std::size_t view) const {
    const std::size_t base = shared::kCounterDiscards + 4 * view;
    return {values[base + shared::kDiscardFrustum], values[base + shared::kDiscardId],
            values[base + shared::kDiscardPlane], values[base + shared::kDiscardNormal]};
}

// Views lie one after the other in `rgb8`, view_stride() pixels apart.
void GridRendererState::record_download(Downloaded& result) {
    result.counters.resize(counter_count());
    std::vector<gpu::ReadbackPart> parts{
        {.buffer = &counters, .bytes = std::as_writable_bytes(std::span(result.counters))}};
    result.views.views.reserve(wanted);
    for (std::size_t i = 0; i < wanted; ++i) {
        Plane image{PlaneSemantic::kColour, PlaneFormat::kRgb8, request.width_px, request.height_px, {}};
        image.bytes.resize(plane_bytes(image.format, image.width_px, image.height_px));
        result.views.views.push_back({request.positions[i], std::move(image), {}});
        parts.push_back({&rgb8, 3ULL * view_stride(request) * i, result.views.views.back().image.bytes});
    }
    if (!rgb8.is_cached()) { // otherwise the host reads it without a copy on the device
        recorder.stage("download");
    }
    readback.record(recorder, std::move(parts));
}

GridRenderer::GridRenderer(const gpu::Device& device, const scene::GpuScene& scene)
    : state_(std::make_unique<GridRendererState>(device, scene)) {}

GridRenderer::~GridRenderer() = default;

Views GridRenderer::render(const SourcePlanes& source, const ViewRequest& request) {
    FC_ASSERT(!request.positions.empty() && request.width_px > 0 && request.height_px > 0, "nothing to render");
    GridRendererState& s = *state_;
    FrameHeader header = source.header();
    const HoleFiller::Batch batch = s.make_batch(header, request);
    s.resize(source);
    s.place_views(header.source);
    s.begin_filter(header);

    s.record_cameras(source, batch.corners);
    s.recorder.fill(s.counters, 0);
    s.recorder.barrier();
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
    GridRendererState::Downloaded result;
    s.record_download(result);
    s.recorder.submit();
    s.readback.finish();
    if (s.filter != nullptr) {
        s.filter->end();
    }

    append_times(s.recorder, header.render_times);
    s.invalid_samples += result.counters[shared::kCounterInvalidSamples];
    s.hole_counts = HoleFiller::counts(result.counters);
    for (std::size_t i = 0; i < s.wanted; ++i) {
        result.views.views[i].discards = s.discards(result.counters, i);
    }
    result.views.header = std::move(header);
    return std::move(result.views);
}

} // namespace fieldcast::render
