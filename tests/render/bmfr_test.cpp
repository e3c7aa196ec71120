// SPDX-License-Identifier: Apache-2.0
// Images that BMFR filters: constant light, edges, noise, energy, changes, layers.
#include "core/image/packing.h"
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

class BmfrTest : public RenderTest {
protected:
    /// Diffuse light of all pages, in the last of `frames` frames of one pose.
    std::vector<glm::vec3> light(const scene::Scene& scene, const Camera& camera, Denoiser denoiser,
                                 std::uint32_t frames) const {
        const scene::GpuScene gpu_scene(device(), scene, traversal());
        SourceRenderer renderer(device(), gpu_scene);
        std::vector<glm::vec3> last;
        for (std::uint32_t frame = 0; frame < frames; ++frame) {
            FrameHeader header = plain_header(camera, 1);
            header.frame_id = header.noise_frame = frame;
            header.cut = frame == 0;
            header.settings.denoiser = denoiser;
            header.settings.temporal_accumulation = true;
            const std::array wanted{PlaneSemantic::kDiffuse};
            last = image::unpack_plane(renderer.render(header).download(wanted).planes.front());
        }
        EXPECT_EQ(renderer.invalid_sample_count(), 0U);
        return last;
    }
};

/// Mean of the green channel, and its standard deviation over the mean.
std::pair<double, double> spread(std::span<const glm::vec3> pixels) {
    double sum = 0.0;
    double squares = 0.0;
    for (const glm::vec3& pixel : pixels) {
        sum += static_cast<double>(pixel.y);
        squares += static_cast<double>(pixel.y) * static_cast<double>(pixel.y);
    }
    const double n = static_cast<double>(pixels.size());
    return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n)) / (sum / n)};
}

TEST_F(BmfrTest, ConstantIlluminationPassesUnchanged) {
    // In a constant sky every sample of every visible point of a box is 1. The image size is not a multiple of a block.
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(1.0F);
    builder.add(box({}, glm::vec3(0.5F)), builder.add_material(diffuse({0.8F, 0.2F, 0.1F})));
    std::size_t sky = 0;
    for (const std::uint32_t frames : {1U, 6U}) {
        const Camera camera = look_at({0.7F, 0.5F, 2}, {0, 0, 0}, 0.8F, 75, 41);
        for (const glm::vec3& pixel : light(builder.scene(), camera, Denoiser::kBmfr, frames)) {
            // Sky pixels stay 0. The precision of R11G11B10F is 2^-7.
            EXPECT_TRUE(pixel.y == 0.0F || std::abs(pixel.y - 1.0F) < 0.01F) << pixel.y;
            sky += pixel.y == 0.0F ? 1 : 0;
        }
    }
    EXPECT_GT(sky, 500U);
}

TEST_F(BmfrTest, LightFollowsNormals) {
    // A roof of two slopes under a directional light shows two exact, different values side by side in one block.
    SceneBuilder builder;
    builder.add(rectangle({-1, 0, 0}, {1, 0.5F, 0}, {0, 0, -2}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({1, 0, 0}, {1, -0.5F, 0}, {0, 0, -2}), builder.add_material(diffuse(glm::vec3(0.5F))));
    scene::Light light_source;
    light_source.intensity = glm::vec3(3.0F);
    const glm::vec3 towards = glm::normalize(glm::vec3(0.8F, -1, 0));
    builder.add_light(light_source, facing({}, towards));
    const Camera camera = look_at({0, 4, 0.5F}, {0, 0, 0}, 0.4F, 48, 48);
    const std::vector<glm::vec3> filtered = light(builder.scene(), camera, Denoiser::kBmfr, 1);
    const float slope = 1.0F / std::sqrt(1.25F);
    const glm::vec2 expected =
        glm::vec2(glm::dot(-towards, glm::vec3(-0.5F, 1, 0)), glm::dot(-towards, glm::vec3(0.5F, 1, 0))) * slope *
        3.0F / glm::pi<float>();
    for (std::uint32_t x = 0; x < 48; ++x) {
        // The precision of R11G11B10F is 2^-7; the ridge reduces the difference by 2e-4.
        EXPECT_NEAR(filtered[std::size_t{48} * 24 + x].y, x < 24 ? expected.x : expected.y, 0.01F) << x;
    }
}

TEST_F(BmfrTest, SurroundingsKeepTheEdgeOfAShadow) {
    // A blocker above the camera shadows half of a plane under a directional light. No feature shows this edge.
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({-5, 3, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.0F))));
    scene::Light light_source;
    light_source.intensity = glm::vec3(3.0F);
    builder.add_light(light_source, facing({}, {0, -1, 0}));
    const Camera camera = look_at({0, 2, 0.2F}, {0, 0, 0}, 0.4F, 64, 64);
    for (const std::uint32_t frames : {1U, 10U}) {
        const std::vector<glm::vec3> filtered = light(builder.scene(), camera, Denoiser::kBmfr, frames);
        for (std::uint32_t x = 0; x < 64; ++x) {
            if (x < 28 || x >= 36) { // at least four pixels from the edge all neighbours are on the same side
                EXPECT_NEAR(filtered[std::size_t{64} * 32 + x].y, x < 32 ? 0.0F : 3.0F / glm::pi<float>(), 0.01F) << x;
            }
        }
    }
}

TEST_F(BmfrTest, NoiseOnAPlaneFallsAndTheMeanStays) {
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({0, 2, 0}, {1.5F, 0, 0}, {0, 0, 1.5F}), builder.add_material(emitter(glm::vec3(5.0F))));
    const Camera camera = look_at({0, 1.5F, 0.2F}, {0, 0, 0}, 0.3F, 64, 64);
    const auto noisy = spread(light(builder.scene(), camera, Denoiser::kNone, 1));
    for (const std::uint32_t frames : {1U, 12U}) {
        const auto smooth = spread(light(builder.scene(), camera, Denoiser::kBmfr, frames));
        RecordProperty("spread" + std::to_string(frames),
                       std::to_string(noisy.second) + " to " + std::to_string(smooth.second));
        // Ten weights from 1024 pixels leave √(10/1024) = 1/10 of the spread. In later frames, limits from 25 pixels of
        // nine frames each and the average of ten results do not increase it. The light itself varies by 2 %.
        EXPECT_LT(smooth.second, noisy.second / 10.0 + 0.02) << frames;
        EXPECT_NEAR(smooth.first, noisy.first, 4.5 * noisy.second / 64 * noisy.first); // 4.5 standard errors
    }
}

TEST_F(BmfrTest, KeepsTheEnergyOfAPicture) {
    const scene::Scene scene = area_lit_room();
    const Camera camera = room_camera(96, 64);
    const auto noisy = spread(light(scene, camera, Denoiser::kNone, 20));
    const auto smooth = spread(light(scene, camera, Denoiser::kBmfr, 20));
    RecordProperty("means", std::to_string(noisy.first) + " to " + std::to_string(smooth.first));
    // A fit keeps the mean of its block. Limits remove bright samples in dark surroundings, and add light where a fit
    // falls below zero; together this is 0.1 % here.
    EXPECT_NEAR(smooth.first, noisy.first, 0.01 * noisy.first);
}

// A lamp jumps, without noise. Measures the share of its old light in the middle of the image eight frames later.
TEST_F(BmfrTest, BothAveragesFollowLightAsTheirWeightsSay) {
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    scene::Light lamp;
    lamp.type = scene::LightType::kPoint;
    lamp.intensity = glm::vec3(3.0F);
    builder.add_light(lamp, at({0, 1, 0}));
    scene::Scene scene = builder.scene();
    scene.nodes.back() = {}; // the animation gives its position
    scene.nodes.back().is_animated = true;
    scene::AnimationChannel channel;
    channel.node = static_cast<std::uint32_t>(scene.nodes.size() - 1);
    channel.times_s = {0.0F, 0.49F, 0.5F, 1.0F};
    channel.values = {glm::vec4(0, 1, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 2, 0, 0), glm::vec4(0, 2, 0, 0)};
    scene.channels.push_back(channel);
    scene.duration_s = 1.0;
    scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer renderer(device(), gpu_scene);
    std::vector<double> middle;
    for (std::uint32_t frame = 0; frame < 48; ++frame) {
        FrameHeader header = plain_header(look_at({0, 3, 0.5F}, {0, 0, 0}, 0.4F, 48, 48), 1);
        header.frame_id = header.noise_frame = frame;
        header.cut = frame == 0;
        header.scene_time_ns = frame < 40 ? frame * 10'000'000LL : 500'000'000LL + frame * 1'000'000LL;
        header.settings.max_bounces = 1;
        header.settings.denoiser = Denoiser::kBmfr;
        header.settings.temporal_accumulation = true;
        gpu_scene.pose(header.scene_time_ns, header.cut);
        const std::array wanted{PlaneSemantic::kDiffuse};
        const auto light = image::unpack_plane(renderer.render(header).download(wanted).planes.front());
        middle.push_back(static_cast<double>(light[std::size_t{48} * 24 + 24].y));
    }
    const double before = middle[39];
    const double after = before / 4; // the lamp is twice as far away
    double noisy = 1.0;              // share of the old light in the noisy average
    double filtered = 1.0;           // share of the old light in the filtered average
    for (int frame = 0; frame < 8; ++frame) {
        noisy *= 0.8;
        filtered = 0.9 * filtered + 0.1 * noisy;
    }
    const double left = (middle.back() - after) / (before - after);
    RecordProperty("left", std::to_string(left) + " of " + std::to_string(filtered));
    // R11G11B10F errs by 1 % of `middle`, which is at most 3/4 of the scale. The rest is the error of fits to a spot.
    EXPECT_NEAR(left, filtered, 0.03);
}

TEST_F(BmfrTest, FiltersBlendSurfacesInTheirOwnPage) {
    // A pane in front of a wall and the sky beside it, under a large lamp.
    SceneBuilder builder;
    builder.add(rectangle({0, 0, -1}, {1, 0, 0}, {0, 2, 0}), builder.add_material(diffuse(glm::vec3(0.5F))));
    scene::Material glass = diffuse(glm::vec3(0.5F));
    glass.alpha_mode = scene::AlphaMode::kBlend;
    glass.base_colour_factor.a = 0.5F;
    builder.add(rectangle({0, 0, 0}, {0.6F, 0, 0}, {0, 0.6F, 0}), builder.add_material(glass));
    builder.add(rectangle({0, 2, 2}, {1.5F, 0, 0}, {0, -1, 1}), builder.add_material(emitter(glm::vec3(5.0F))));
    const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, 0.7F, 64, 64);
    const auto noisy = light(builder.scene(), camera, Denoiser::kNone, 1);
    const auto smooth = light(builder.scene(), camera, Denoiser::kBmfr, 1);
    ASSERT_EQ(smooth.size(), std::size_t{3} * 64 * 64); // the wall's page, then two pages for layers
    std::array<std::vector<glm::vec3>, 2> pane;
    for (std::size_t i = 0; i < smooth.size(); ++i) {
        const std::size_t page = i / 4096;
        const glm::ivec2 from_middle = glm::abs(glm::ivec2(i % 64, i / 64 % 64) - 32);
        if (page == 1 && from_middle.x < 12 && from_middle.y < 12) { // the pane extends 17.5 pixels to each side
            pane[0].push_back(noisy[i]);
            pane[1].push_back(smooth[i]);
        } else if (page == 2 || (page == 1 && (from_middle.x > 20 || from_middle.y > 20))) {
            EXPECT_EQ(smooth[i], glm::vec3(0.0F)); // no surface
        }
    }
    const auto before = spread(pane[0]);
    const auto after = spread(pane[1]);
    RecordProperty("spread", std::to_string(before.second) + " to " + std::to_string(after.second));
    EXPECT_GT(before.second, 0.1);
    // As on a plane, but with at least a third of a block's pixels: √(10/300). The light itself varies over the pane.
    EXPECT_LT(after.second, before.second / 5.0 + 0.1);
    EXPECT_NEAR(after.first, before.first, 4.5 * before.second / 24 * before.first);
}

TEST_F(BmfrTest, AnEmptyPictureAndASmallOneStayFinite) {
    SceneBuilder builder;
    builder.add(box({0, 0, 9}, glm::vec3(0.5F)), builder.add_material(metal(glm::vec3(0.9F), 0.1F)));
    builder.environment().constant = glm::vec3(2.0F);
    for (const std::uint32_t size : {1U, 40U}) {
        for (const glm::vec3 target : {glm::vec3(0, 0, -1), glm::vec3(0, 0, 9)}) { // away from the box, then at it
            const Camera camera = look_at({0, 0, 7}, target, 0.7F, size, size);
            for (const glm::vec3& pixel : light(builder.scene(), camera, Denoiser::kBmfr, 3)) {
                EXPECT_TRUE(std::isfinite(pixel.x) && pixel.x >= 0.0F);
            }
        }
    }
}

} // namespace
} // namespace fieldcast::render
