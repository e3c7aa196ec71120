// SPDX-License-Identifier: Apache-2.0
#include "core/render/reference_renderer.h"

#include "core/base/error.h"

#include "core/render/camera_record.h"
#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"

namespace fieldcast::render {

struct ReferenceRenderer::State {
    State(const gpu::Device& d, const scene::GpuScene& s)
        : device(d), scene(s), recorder(d),
          kernel(make_scene_kernel(d, s, KernelId::kTraceReference, sizeof(shared::TraceReferenceParams))),
          camera_record(d, sizeof(shared::CameraRecord)), invalid_samples(d, 16) {
        recorder.fill(invalid_samples, 0);
        recorder.submit();
    }

    const gpu::Device& device;
    const scene::GpuScene& scene;
    gpu::CommandRecorder recorder;
    gpu::Kernel kernel;
    gpu::Buffer camera_record;
    gpu::Buffer invalid_samples;
    gpu::Buffer film;
    Camera camera;
    std::uint32_t samples = 0;
};

ReferenceRenderer::ReferenceRenderer(const gpu::Device& device, const scene::GpuScene& scene)
    : state_(std::make_unique<State>(device, scene)) {}

ReferenceRenderer::~ReferenceRenderer() = default;

void ReferenceRenderer::start(const Camera& camera) {
    State& s = *state_;
    s.camera = camera;
    s.samples = 0;
    s.film = gpu::Buffer(s.device, static_cast<std::uint64_t>(camera.width_px) * camera.height_px * 16);
    const shared::CameraRecord record = make_camera_record(camera);
    gpu::write_buffer(s.device, s.camera_record, std::as_bytes(std::span(&record, 1)));
    s.recorder.fill(s.film, 0);
    s.recorder.submit();
}

void ReferenceRenderer::resume(const Camera& camera, const std::vector<glm::vec3>& image,
                               std::uint32_t samples_per_pixel) {
    start(camera);
    FC_ASSERT(image.size() == static_cast<std::size_t>(camera.width_px) * camera.height_px,
              "the image does not have the camera's size");
    std::vector<glm::vec4> film;
    film.reserve(image.size());
    const auto samples = static_cast<float>(samples_per_pixel);
    for (const glm::vec3& mean : image) {
        film.emplace_back(mean * samples, samples);
    }
    gpu::write_buffer(state_->device, state_->film, std::as_bytes(std::span(film)));
    state_->samples = samples_per_pixel;
}

void ReferenceRenderer::accumulate(const RenderSettings& settings, std::uint32_t seed) {
    State& s = *state_;
    FC_ASSERT(s.film, "accumulate() needs start() first");
    shared::TraceReferenceParams params{};
    params.camera = s.camera_record.address();
    params.film = s.film.address();
    params.invalid_samples = s.invalid_samples.address();
    params.width = s.camera.width_px;
    params.height = s.camera.height_px;
    params.seed = seed;
    params.first_sample = s.samples;
    params.samples_per_pixel = settings.samples_per_pixel;
    params.path = path_bits(settings);
    params.max_indirect = max_indirect(settings);
    s.recorder.stage("reference");
    s.recorder.dispatch(s.kernel, {&s.scene.bindings()}, params,
                        {gpu::groups_for(params.width, 8), gpu::groups_for(params.height, 8), 1});
    s.recorder.submit();
    s.samples += settings.samples_per_pixel;
}

std::vector<glm::vec3> ReferenceRenderer::image() const {
    const State& s = *state_;
    const std::size_t count = static_cast<std::size_t>(s.camera.width_px) * s.camera.height_px;
    std::vector<glm::vec3> pixels;
    pixels.reserve(count);
    for (const glm::vec4& sum : gpu::read_buffer_as<glm::vec4>(s.device, s.film, count)) {
        pixels.push_back(glm::vec3(sum) / std::max(sum.w, 1.0F));
    }
    return pixels;
}

std::uint32_t ReferenceRenderer::samples_per_pixel() const {
    return state_->samples;
}

std::uint64_t ReferenceRenderer::invalid_sample_count() const {
    return gpu::read_buffer_as<std::uint32_t>(state_->device, state_->invalid_samples, 1).front();
}

} // namespace fieldcast::render
