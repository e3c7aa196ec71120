// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"
#include "core/scene/gpu_scene.h"

#include <memory>
#include <vector>

namespace fieldcast::render {

/// Path traces single views without reuse or denoising and accumulates them: ground truth for tests and benchmarks.
/// Rays go through pixel centres, as everywhere. Unbiased if `settings.indirect_clamp` is 0.
class ReferenceRenderer {
public:
    ReferenceRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~ReferenceRenderer();

    /// Starts a new image of the scene as it is posed now.
    void start(const Camera& camera);

    /// Goes on with an image that has `samples_per_pixel` samples: `image` is what image() gave, of the camera's size.
    void resume(const Camera& camera, const std::vector<glm::vec3>& image, std::uint32_t samples_per_pixel);

    /// Adds `settings.samples_per_pixel` samples per pixel (of settings, only what concerns paths is used).
    void accumulate(const RenderSettings& settings, std::uint32_t seed);

    /// Mean linear radiance so far, row-major, unexposed.
    std::vector<glm::vec3> image() const;
    std::uint32_t samples_per_pixel() const;
    std::uint64_t invalid_sample_count() const; ///< must stay 0

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::render
