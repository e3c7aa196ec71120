// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"
#include "core/scene/gpu_scene.h"

#include <memory>
#include <vector>

namespace fieldcast::render {

/// Path traces single views without reuse or denoising and accumulates them, as ground truth for tests and benchmarks.
/// Rays go through pixel centres, as in all renderers. Unbiased if `settings.indirect_clamp` is 0.
class ReferenceRenderer {
public:
    ReferenceRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~ReferenceRenderer();

    /// Starts a new image of the scene in its current pose.
    void start(const Camera& camera);

    /// Continues an image that already has `samples_per_pixel` samples. `image` is a result of image() of the camera's
    /// size.
    void resume(const Camera& camera, const std::vector<glm::vec3>& image, std::uint32_t samples_per_pixel);

    /// Adds `settings.samples_per_pixel` samples per pixel. Only the settings of path tracing are used.
    void accumulate(const RenderSettings& settings, std::uint32_t seed);

    /// Mean linear radiance of all samples, row-major, without exposure.
    std::vector<glm::vec3> image() const;
    std::uint32_t samples_per_pixel() const;
    std::uint64_t invalid_sample_count() const; ///< NaN or infinite samples; must stay 0

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::render
