// SPDX-License-Identifier: Apache-2.0
#include "tests/render/render_test.h"

namespace fieldcast::render {

Average average(const Estimate& estimate, std::uint32_t x0, std::uint32_t y0, std::uint32_t width,
                std::uint32_t height) {
    Average result;
    glm::dvec3 variance(0.0);
    for (std::uint32_t y = y0; y < y0 + height; ++y) {
        for (std::uint32_t x = x0; x < x0 + width; ++x) {
            result.mean += estimate.mean[estimate.index(x, y)];
            variance += estimate.variance[estimate.index(x, y)];
        }
    }
    const double count = static_cast<double>(width) * height;
    result.mean /= count;
    result.standard_error = glm::sqrt(variance) / count;
    return result;
}

Average average(const Estimate& estimate) {
    return average(estimate, 0, 0, estimate.width_px, estimate.height_px);
}

Estimate RenderTest::path_trace(const scene::Scene& scene, const Camera& camera, const PathTracing& options) const {
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    ReferenceRenderer renderer(device(), gpu_scene);
    RenderSettings settings;
    settings.samples_per_pixel = options.samples;
    settings.max_bounces = options.max_bounces;
    settings.next_event_estimation = options.next_event_estimation;
    settings.light_sampling = options.light_sampling;
    settings.indirect_clamp = 0.0F;
    const std::size_t count = static_cast<std::size_t>(camera.width_px) * camera.height_px;
    Estimate estimate{camera.width_px, camera.height_px, std::vector<glm::dvec3>(count),
                      std::vector<glm::dvec3>(count)};
    for (std::uint32_t render = 0; render < options.renders; ++render) {
        renderer.start(camera);
        renderer.accumulate(settings, 1000 + render);
        const std::vector<glm::vec3> image = renderer.image();
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 value(image[i]);
            estimate.mean[i] += value;
            estimate.variance[i] += value * value;
        }
    }
    const double n = options.renders;
    for (std::size_t i = 0; i < count; ++i) {
        estimate.mean[i] /= n;
        const glm::dvec3 spread = estimate.variance[i] / n - estimate.mean[i] * estimate.mean[i];
        estimate.variance[i] = glm::max(spread, glm::dvec3(0.0)) / std::max(n - 1.0, 1.0);
    }
    EXPECT_EQ(renderer.invalid_sample_count(), 0U);
    return estimate;
}

FrameHeader plain_header(const Camera& camera, std::uint32_t samples) {
    FrameHeader header;
    header.cut = true;
    header.seed = 7;
    header.source = camera;
    header.settings.samples_per_pixel = samples;
    header.settings.indirect_clamp = 0.0F;
    header.settings.denoiser = Denoiser::kNone;
    header.settings.temporal_accumulation = false;
    header.settings.history_light = false;
    header.settings.holes = HoleFilling::path_traced();
    return header;
}

ViewRequest grid_request(const Camera& source, std::uint32_t rows, std::uint32_t cols,
                         const LatticeGeometry& geometry) {
    const ViewGrid grid{rows, cols, geometry};
    return {geometry, vertical_fov(source), source.width_px, source.height_px, lattice_positions(grid)};
}

} // namespace fieldcast::render
