// SPDX-License-Identifier: Apache-2.0
#include "core/image/packing.h"
#include "tests/render/render_test.h"

#include <cmath>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kSize = 48;

/// A board over a floor, lit by a sun and a noisy sky with one small bright spot. Its shadow has a sharp edge.
scene::Scene sunlit_floor() {
    SceneBuilder builder;
    scene::Environment& sky = builder.environment();
    sky.width_px = 32;
    sky.height_px = 16;
    sky.pixels.assign(32 * 16, glm::vec3(0.05F));
    sky.pixels[3 * 32 + 5] = glm::vec3(40.0F);
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({0.35F, 0.4F, 0}, {0.3F, 0, 0.1F}, {0.1F, 0, -0.3F}),
                builder.add_material(diffuse(glm::vec3(0.5F))));
    scene::Light sun;
    sun.intensity = glm::vec3(3.0F);
    builder.add_light(sun, facing({}, glm::normalize(glm::vec3(-0.8F, -1, 0.1F))));
    return builder.scene();
}

using PunctualFilterTest = RenderTest;

class Floor {
public:
    Floor(const gpu::Device& device, const scene::Scene& scene, scene::Traversal traversal)
        : device_(device), gpu_scene_(device, scene, traversal) {}

    static FrameHeader header(bool is_apart) {
        FrameHeader header = plain_header(look_at({0, 3, 0.5F}, {0, 0, 0}, 0.5F, kSize, kSize), 1);
        header.settings.denoiser = Denoiser::kSvgfPlus;
        header.settings.temporal_accumulation = true;
        header.settings.light_sampling.each_kind = is_apart;
        return header;
    }

    std::vector<glm::vec3> render(const FrameHeader& header) {
        gpu_scene_.pose(0, header.cut);
        const std::array wanted{PlaneSemantic::kDiffuse};
        return image::unpack_plane(renderer_.render(header).download(wanted).planes.front());
    }

    /// Light after `frames` frames without motion.
    std::vector<glm::vec3> render_frames(std::uint32_t frames, bool is_apart, bool accumulates = false) {
        std::vector<glm::vec3> light;
        for (std::uint32_t frame = 0; frame < frames; ++frame) {
            FrameHeader next = header(is_apart);
            next.frame_id = next.noise_frame = frame;
            next.cut = frame == 0;
            next.settings.accumulate = accumulates;
            light = render(next);
        }
        return light;
    }

    std::vector<glm::vec3> truth() {
        FrameHeader exact = header(true);
        exact.settings.denoiser = Denoiser::kNone;
        exact.settings.temporal_accumulation = false;
        exact.settings.samples_per_pixel = 512;
        return render(exact);
    }

private:
    const gpu::Device& device_;
    scene::GpuScene gpu_scene_;
    SourceRenderer renderer_{device_, gpu_scene_};
};

double rmse(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = static_cast<double>(a[i].y) - static_cast<double>(b[i].y);
        sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

double mean(const std::vector<glm::vec3>& light) {
    double sum = 0.0;
    for (const glm::vec3& pixel : light) {
        sum += static_cast<double>(pixel.y);
    }
    return sum / static_cast<double>(light.size());
}

TEST_F(PunctualFilterTest, KeepsShadowsSharpUnderANoisySky) {
    const scene::Scene scene = sunlit_floor();
    Floor floor(device(), scene, traversal());
    const std::vector<glm::vec3> truth = floor.truth();
    const double together = rmse(floor.render_frames(8, false), truth);
    const std::vector<glm::vec3> apart = floor.render_frames(8, true);
    RecordProperty("together", std::to_string(together));
    RecordProperty("apart", std::to_string(rmse(apart, truth)));
    EXPECT_LT(rmse(apart, truth), 0.6 * together);
    EXPECT_NEAR(mean(apart), mean(truth), 0.02 * mean(truth)); // eight samples of the sky in each of 2304 pixels
}

// Averaged frames without filter must have all light, and the frames before and after must not show it twice.
TEST_F(PunctualFilterTest, StillFramesHaveAllLight) {
    const scene::Scene scene = sunlit_floor();
    Floor floor(device(), scene, traversal());
    const std::vector<glm::vec3> truth = floor.truth();
    const std::vector<glm::vec3> still = floor.render_frames(64, true, true);
    EXPECT_NEAR(mean(still), mean(truth), 0.01 * mean(truth));
    EXPECT_LT(rmse(still, truth), 0.1 * mean(truth));
    FrameHeader moved = Floor::header(true);
    moved.cut = false;
    moved.frame_id = moved.noise_frame = 64;
    moved.settings.accumulate = true;
    moved.source.world_from_camera[3].x += 0.001F;
    EXPECT_NEAR(mean(floor.render(moved)), mean(truth), 0.02 * mean(truth));
}

// The renderer changes from one light sample for all kinds to one for each kind; no light may count twice.
TEST_F(PunctualFilterTest, OtherSettingsStartAnew) {
    const scene::Scene scene = sunlit_floor();
    Floor floor(device(), scene, traversal());
    const double expected = mean(floor.truth());
    floor.render_frames(4, false);
    FrameHeader next = Floor::header(true);
    next.cut = false;
    next.frame_id = next.noise_frame = 4;
    EXPECT_NEAR(mean(floor.render(next)), expected, 0.05 * expected); // the noise of one frame
}

} // namespace
} // namespace fieldcast::render
