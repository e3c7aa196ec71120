// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/reference_renderer.h"
#include "core/render/source/source_renderer.h"
#include "core/render/views/grid_renderer.h"
#include "tests/gpu/gpu_test.h"
#include "tests/render/test_scenes.h"

namespace fieldcast::render {

/// Mean of independent renders of one view, and its variance.
struct Estimate {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<glm::dvec3> mean;
    std::vector<glm::dvec3> variance; ///< variance of `mean`, from the spread of the renders

    std::size_t index(std::uint32_t x, std::uint32_t y) const { return static_cast<std::size_t>(y) * width_px + x; }
};

/// Mean and standard error of the mean of a region's pixels, per channel.
struct Average {
    glm::dvec3 mean{0.0};
    glm::dvec3 standard_error{0.0};
};

Average average(const Estimate& estimate, std::uint32_t x0, std::uint32_t y0, std::uint32_t width,
                std::uint32_t height);
Average average(const Estimate& estimate);

/// Options of RenderTest::path_trace().
struct PathTracing {
    std::uint32_t samples = 16; ///< samples per pixel and render
    std::uint32_t renders = 4;  ///< number of renders with different seeds
    std::uint32_t max_bounces = 8;
    bool next_event_estimation = true;
    LightSampling light_sampling = LightSampling::plain();
};

/// Tests of renderers on the best device of this machine; skips without one, fails on validation messages.
class RenderTest : public gpu::GpuTest {
public:
    /// A scene in one renderer of each kind. Views are traced, as their references are. In rooms that are symmetric
    /// about the camera, the centres of whole rows of pixels lie on edges, where a rasteriser may show the other side.
    struct Stage {
        Stage(const gpu::Device& device, scene::Scene shown, scene::Traversal traversal)
            : scene(std::move(shown)), gpu_scene(device, scene, traversal, scene::VisibilityMethod::kRays), source(device, gpu_scene),
              grid(device, gpu_scene), reference(device, gpu_scene) {}
        scene::Scene scene;
        scene::GpuScene gpu_scene;
        SourceRenderer source;
        GridRenderer grid;
        ReferenceRenderer reference;
    };

protected:
    scene::Traversal traversal() const { return scene::choose_traversal(device(), "auto"); }

    Stage stage(scene::Scene scene) const { return {device(), std::move(scene), traversal()}; }

    /// Path traces `camera` without reuse and without clamps. Fails on invalid samples.
    Estimate path_trace(const scene::Scene& scene, const Camera& camera, const PathTracing& options) const;
};

/// Header of a frame with `samples` per pixel without denoiser, history and clamps.
FrameHeader plain_header(const Camera& camera, std::uint32_t samples);

/// A grid of views of the source's size and field of view.
ViewRequest grid_request(const Camera& source, std::uint32_t rows, std::uint32_t cols, const LatticeGeometry& geometry);

} // namespace fieldcast::render
