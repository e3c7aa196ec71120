// SPDX-License-Identifier: Apache-2.0
#include "core/render/source/source_renderer.h"

#include "core/render/camera_record.h"
#include "core/render/denoise/illumination_filter.h"
#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "core/render/source/light_merger.h"
#include "core/render/source/source_surfaces.h"

namespace fieldcast::render {

namespace {

std::vector<Camera> source_cameras(const SourcePlanes& planes) {
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < planes.source_count(); ++i) {
        cameras.push_back(planes.camera(i));
    }
    return cameras;
}

} // namespace

struct SourceRenderer::State {
    State(const gpu::Device& d, const scene::GpuScene& s)
        : device(d), scene(s), recorder(d), planes(d), surfaces(d, s), filter(d, s),
          trace(make_scene_kernel(d, s, KernelId::kTraceSource, sizeof(shared::TraceSourceParams))),
          pack(make_plain_kernel(d, KernelId::kPackSource, sizeof(shared::PackParams))),
          cameras(d, 2 * kMaxSources * sizeof(shared::CameraRecord)), invalid_samples(d, 16) {
        recorder.fill(invalid_samples, 0);
        recorder.submit();
    }

    bool has_history(const FrameHeader& header) const;
    std::uint32_t still_frames(const FrameHeader& header) const;
    void upload_cameras();
    void record_trace(bool ends_in_history);
    void record_filter(bool has_history, bool is_still);
    void record_pack();
    struct Packed {
        const gpu::Buffer& diffuse;
        const gpu::Buffer& specular;
        const gpu::Buffer* punctual = nullptr; ///< diffuse light to add; null: none
    };
    void pack_pages(std::uint32_t first, std::uint32_t count, const Packed& light);

    const gpu::Device& device;
    const scene::GpuScene& scene;
    gpu::CommandRecorder recorder;
    SourcePlanes planes;
    SourceSurfaces surfaces;
    IlluminationFilter filter;
    gpu::Kernel trace;
    gpu::Kernel pack;
    gpu::Buffer cameras; ///< CameraRecords of this frame, then of the previous one
    gpu::Buffer invalid_samples;
    std::unique_ptr<LightMerger> merger; ///< null until the first total_light()
    std::vector<Camera> previous; ///< source cameras of the previous frame
    FrameHeader last;             ///< header of the previous frame
    bool is_punctual_apart = false;
    bool has_stored_history = false; ///< the previous frame was accumulated or filtered
};

bool SourceRenderer::State::has_history(const FrameHeader& header) const {
    const Camera now = widened_source(header, 0);
    return has_stored_history && !header.cut && keeps_punctual_apart(header) == keeps_punctual_apart(last) &&
           previous.size() == header.source_positions.size() && previous[0].width_px == now.width_px &&
           previous[0].height_px == now.height_px;
}

// Number of averaged frames without motion that precede this one; 0 if this one differs or averaging is off.
std::uint32_t SourceRenderer::State::still_frames(const FrameHeader& header) const {
    const bool is_still = !previous.empty() && !header.cut && header.source == last.source &&
                          header.source_positions == last.source_positions && header.guard_band == last.guard_band &&
                          header.scene_time_ns == last.scene_time_ns && header.settings == last.settings;
    return header.settings.accumulate && is_still ? last.still_frames + 1 : 0;
}

void SourceRenderer::State::upload_cameras() {
    const std::vector<Camera> now = source_cameras(planes);
    std::vector<shared::CameraRecord> records = make_camera_records(now);
    const std::vector<shared::CameraRecord> before =
        make_camera_records(previous.size() == now.size() ? previous : now);
    records.insert(records.end(), before.begin(), before.end());
    gpu::write_buffer(device, cameras, std::as_bytes(std::span(records)));
}

void SourceRenderer::State::record_trace(bool ends_in_history) {
    const FrameHeader& header = planes.header();
    const Camera camera = planes.camera();
    shared::TraceSourceParams params{};
    params.cameras = cameras.address();
    params.visibility = surfaces.visibility().address();
    params.layers = surfaces.layers().address();
    params.tiles = surfaces.tiles().list().address();
    params.diffuse = filter.noisy_diffuse().address();
    params.specular = filter.noisy_specular().address();
    params.punctual = is_punctual_apart ? filter.noisy_punctual().address() : 0;
    params.invalid_samples = invalid_samples.address();
    params.previous_geometry = filter.previous_geometry().address();
    params.previous_diffuse = planes.plane(PlaneSemantic::kDiffuse).address();
    params.previous_specular = planes.plane(PlaneSemantic::kSpecular).address();
    params.width = camera.width_px;
    params.height = camera.height_px;
    params.seed = header.seed;
    params.first_sample = header.noise_frame * header.settings.samples_per_pixel;
    params.samples_per_pixel = header.settings.samples_per_pixel;
    params.source_count = planes.source_count();
    params.path = path_bits(header.settings) | (is_punctual_apart ? shared::kPathPunctualApart : 0U) |
                  (ends_in_history ? shared::kPathEndsInHistory : 0U);
    params.max_indirect = max_indirect(header);
    recorder.stage("source_trace");
    dispatch_listed(recorder, trace, {&scene.bindings()}, params, surfaces.tiles());
    recorder.barrier();
}

void SourceRenderer::State::record_filter(bool has_history, bool is_still) {
    const FrameHeader& header = planes.header();
    const Camera camera = planes.camera();
    filter.record(recorder, {.cameras = cameras.address(),
                             .visibility = surfaces.visibility().address(),
                             .layers = surfaces.layers().address(),
                             .groups = &surfaces.groups(),
                             .width = camera.width_px,
                             .height = camera.height_px,
                             .page_count = planes.page_count(),
                             .source_count = planes.source_count(),
                             .has_history = has_history,
                             .is_punctual_apart = is_punctual_apart,
                             .is_still = is_still,
                             .least_weight = least_weight(header),
                             .number = header.noise_frame,
                             .settings = header.settings});
}

// If views are denoised, the source's light is packed as traced. Only its layers are filtered, because views do not
// denoise them.
void SourceRenderer::State::record_pack() {
    const std::uint32_t pages = planes.page_count();
    const std::uint32_t noisy_pages = denoises_views(planes.header()) ? planes.source_count() : 0;
    recorder.stage("pack");
    pack_pages(0, noisy_pages, {.diffuse = filter.noisy_diffuse(), .specular = filter.noisy_specular()});
    pack_pages(noisy_pages, pages - noisy_pages,
               {.diffuse = filter.diffuse(), .specular = filter.specular(), .punctual = filter.punctual()});
    recorder.barrier();
}

void SourceRenderer::State::pack_pages(std::uint32_t first, std::uint32_t count, const Packed& light) {
    if (count == 0) {
        return;
    }
    shared::PackParams params{};
    params.id = planes.plane(PlaneSemantic::kId).address();
    params.diffuse_in = light.diffuse.address();
    params.specular_in = light.specular.address();
    params.punctual_in = light.punctual != nullptr ? light.punctual->address() : 0;
    params.is_punctual_apart = light.punctual != nullptr ? 1 : 0;
    params.diffuse = planes.plane(PlaneSemantic::kDiffuse).address();
    params.specular = planes.plane(PlaneSemantic::kSpecular).address();
    params.first_pixel = first * planes.pixel_count();
    params.pixel_count = count * planes.pixel_count();
    recorder.dispatch(pack, {}, params, linear_groups(params.pixel_count));
}

SourceRenderer::SourceRenderer(const gpu::Device& device, const scene::GpuScene& scene)
    : state_(std::make_unique<State>(device, scene)) {}

SourceRenderer::~SourceRenderer() = default;

const SourcePlanes& SourceRenderer::render(const FrameHeader& header) {
    State& s = *state_;
    FrameHeader timed = header;
    timed.render_times.clear();
    timed.layer_count = s.scene.has_blend() ? kMaxLayers : 0;
    timed.still_frames = s.still_frames(header);
    const bool is_still = timed.still_frames > 0;
    const bool has_history = is_still ? timed.still_frames > 1 // the average must not include frames before the series
                                      : s.has_history(header) && header.settings.temporal_accumulation;
    s.planes.resize(timed);
    s.is_punctual_apart = keeps_punctual_apart(timed) && !s.scene.scene().lights.empty();
    s.filter.resize(s.planes.texel_count(), s.is_punctual_apart);
    s.upload_cameras();

    s.surfaces.record(s.recorder, s.planes, s.cameras.address(), s.filter.geometry());
    s.record_trace(header.settings.history_light && has_history && !is_still && !denoises_views(timed));
    const bool is_filtered = !denoises_views(timed) || s.planes.page_count() > s.planes.source_count();
    if (is_filtered) {
        s.record_filter(has_history, is_still);
    }
    s.record_pack();
    s.recorder.submit();

    append_times(s.recorder, timed.render_times);
    s.planes.resize(timed);
    s.filter.swap();
    s.previous = source_cameras(s.planes);
    s.last = timed;
    s.has_stored_history = is_filtered && (is_still || header.settings.temporal_accumulation ||
                                           header.settings.denoiser != Denoiser::kNone);
    return s.planes;
}

Plane SourceRenderer::total_light() {
    State& s = *state_;
    if (s.merger == nullptr) {
        s.merger = std::make_unique<LightMerger>(s.device, s.scene);
    }
    return s.merger->merge(s.planes, s.surfaces, s.cameras.address());
}

std::uint64_t SourceRenderer::invalid_sample_count() const {
    return gpu::read_buffer_as<std::uint32_t>(state_->device, state_->invalid_samples, 1).front();
}

struct SurfacePlanesRenderer::State {
    State(const gpu::Device& d, const scene::GpuScene& s)
        : device(d), recorder(d), surfaces(d, s), cameras(d, kMaxSources * sizeof(shared::CameraRecord)) {}

    const gpu::Device& device;
    gpu::CommandRecorder recorder;
    SourceSurfaces surfaces;
    gpu::Buffer cameras;
    gpu::Buffer geometry;
};

SurfacePlanesRenderer::SurfacePlanesRenderer(const gpu::Device& device, const scene::GpuScene& scene)
    : state_(std::make_unique<State>(device, scene)) {}

SurfacePlanesRenderer::~SurfacePlanesRenderer() = default;

void SurfacePlanesRenderer::render(SourcePlanes& planes) {
    State& s = *state_;
    const std::uint64_t geometry_bytes = static_cast<std::uint64_t>(planes.texel_count()) * 16;
    if (s.geometry.size_bytes() < geometry_bytes) {
        s.geometry = gpu::Buffer(s.device, geometry_bytes);
    }
    const std::vector<shared::CameraRecord> records = make_camera_records(source_cameras(planes));
    gpu::write_buffer(s.device, s.cameras, std::as_bytes(std::span(records)));
    s.surfaces.record(s.recorder, planes, s.cameras.address(), s.geometry);
    s.recorder.submit();
}

} // namespace fieldcast::render
