// SPDX-License-Identifier: Apache-2.0
#include "core/image/packing.h"
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kSize = 48;

class SvgfTest : public RenderTest, public testing::WithParamInterface<Denoiser> {
protected:
    /// Demodulated diffuse light of one frame without history.
    std::vector<glm::vec3> light(const scene::Scene& scene, const Camera& camera, Denoiser denoiser) const {
        const scene::GpuScene gpu_scene(device(), scene, traversal());
        SourceRenderer renderer(device(), gpu_scene);
        FrameHeader header = plain_header(camera, 1);
        header.settings.denoiser = denoiser;
        header.settings.temporal_accumulation = true;
        const std::array wanted{PlaneSemantic::kDiffuse};
        return image::unpack_plane(renderer.render(header).download(wanted).planes.front());
    }
};

TEST_P(SvgfTest, ConstantIlluminationPassesUnchanged) {
    // For convex shapes in a constant sky without ground, every sample of every visible point is 1.
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(1.0F);
    builder.add(box({-0.5F, 0, 0}, glm::vec3(0.3F)), builder.add_material(diffuse({0.8F, 0.2F, 0.1F})));
    builder.add(rectangle({0, 0, -1}, {2, 0, 0}, {0, 2, 0}), builder.add_material(diffuse({0.1F, 0.2F, 0.8F})));
    scene::Scene scene = builder.scene();
    scene.instances.pop_back(); // only the box remains
    for (const glm::vec3& pixel :
         light(scene, look_at({0.2F, 0.4F, 2}, {-0.4F, 0, 0}, 0.6F, kSize, kSize), GetParam())) {
        // Sky pixels stay 0. Other pixels are weighted means of numbers that differ by rounding.
        EXPECT_TRUE(pixel.y == 0.0F || std::abs(pixel.y - 1.0F) < 0.01F) << pixel.y;
    }
}

TEST_P(SvgfTest, EdgesBetweenInstancesAndOrientationsStay) {
    // A roof of two slopes under a directional light shows two exact, different values side by side.
    SceneBuilder builder;
    builder.add(rectangle({-1, 0, 0}, {1, 0.5F, 0}, {0, 0, -2}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({1, 0, 0}, {1, -0.5F, 0}, {0, 0, -2}), builder.add_material(diffuse(glm::vec3(0.5F))));
    scene::Light light_source;
    light_source.intensity = glm::vec3(3.0F);
    const glm::vec3 towards = glm::normalize(glm::vec3(0.8F, -1, 0));
    builder.add_light(light_source, facing({}, towards));
    const Camera camera = look_at({0, 4, 0.5F}, {0, 0, 0}, 0.4F, kSize, kSize);
    const std::vector<glm::vec3> filtered = light(builder.scene(), camera, GetParam());
    const float slope = 1.0F / std::sqrt(1.25F);
    const glm::vec2 expected =
        glm::vec2(glm::dot(-towards, glm::vec3(-0.5F, 1, 0)), glm::dot(-towards, glm::vec3(0.5F, 1, 0))) * slope *
        3.0F / glm::pi<float>();
    ASSERT_GT(std::abs(expected.x - expected.y), 0.3F);
    for (std::uint32_t x = 0; x < kSize; ++x) {
        const float value = filtered[std::size_t{kSize} * (kSize / 2) + x].y;
        // The precision of R11G11B10F is 2^-7.
        EXPECT_NEAR(value, x < kSize / 2 ? expected.x : expected.y, 0.01F) << x;
    }
}

TEST_P(SvgfTest, NoiseOnAPlaneFallsByTheFilter) {
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({0, 2, 0}, {1.5F, 0, 0}, {0, 0, 1.5F}), builder.add_material(emitter(glm::vec3(5.0F))));
    const Camera camera = look_at({0, 1.5F, 0.2F}, {0, 0, 0}, 0.3F, kSize, kSize);
    const auto relative_spread = [](const std::vector<glm::vec3>& pixels) {
        double sum = 0.0;
        double squares = 0.0;
        for (const glm::vec3& pixel : pixels) {
            sum += static_cast<double>(pixel.y);
            squares += static_cast<double>(pixel.y) * static_cast<double>(pixel.y);
        }
        const double n = static_cast<double>(pixels.size());
        return std::pair(sum / n, std::sqrt(squares / n - sum / n * sum / n) / (sum / n));
    };
    const auto noisy = relative_spread(light(builder.scene(), camera, Denoiser::kNone));
    const auto smooth = relative_spread(light(builder.scene(), camera, GetParam()));
    RecordProperty("spread", std::to_string(noisy.second) + " to " + std::to_string(smooth.second));
    // 7×7 pixels and then five levels that reach 62 pixels average far more than 49 pixels, which leaves at most 1/7 of
    // the spread. The variation of the light itself over the image (2 %) remains.
    EXPECT_LT(smooth.second, noisy.second / 7.0 + 0.02);
    EXPECT_NEAR(smooth.first, noisy.first,
                4.5 * noisy.second / kSize * noisy.first); // the mean must stay within 4.5 standard errors
}

// A lamp jumps, without noise. Measures the share of its old light in the middle of the image eight frames later.
TEST_P(SvgfTest, HistoryFollowsLightThatChanges) {
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
    for (std::uint32_t frame = 0; frame < 48; ++frame) { // 40 before the jump, which is longer than any history
        FrameHeader header = plain_header(look_at({0, 3, 0.5F}, {0, 0, 0}, 0.4F, kSize, kSize), 1);
        header.frame_id = header.noise_frame = frame;
        header.cut = frame == 0;
        header.scene_time_ns = frame < 40 ? frame * 10'000'000LL : 500'000'000LL + frame * 1'000'000LL;
        header.settings.max_bounces = 1;
        header.settings.denoiser = GetParam();
        header.settings.temporal_accumulation = true;
        gpu_scene.pose(header.scene_time_ns, header.cut);
        const std::array wanted{PlaneSemantic::kDiffuse};
        const auto light = image::unpack_plane(renderer.render(header).download(wanted).planes.front());
        middle.push_back(static_cast<double>(light[std::size_t{kSize} * kSize / 2 + kSize / 2].y));
    }
    const double before = middle[39];
    const double after = before / 4; // the lamp is twice as far away
    const double left = (middle.back() - after) / (before - after);
    RecordProperty("left", std::to_string(left));
    // α = 0.2 leaves 0.8⁸ = 0.17; a history of 30 frames alone would leave 0.76. The precision of R11G11B10F is 1 %.
    EXPECT_GT(left, -0.02);
    EXPECT_LT(left, 0.2);
}

/// A smooth metal ball that turns in a sky of light and dark squares.
scene::Scene turning_ball() {
    SceneBuilder builder;
    scene::Environment& sky = builder.environment();
    sky.width_px = 64;
    sky.height_px = 32;
    for (std::uint32_t i = 0; i < 64 * 32; ++i) {
        const bool is_light = (i / 8) % 2 == (i / 64 / 8) % 2;
        sky.pixels.push_back(is_light ? glm::vec3(1.0F) : glm::vec3(0.02F));
    }
    builder.add(sphere(0.8F, 96, Shading::kSmooth), builder.add_material(metal(glm::vec3(0.9F), 0.12F)));
    scene::Scene scene = builder.scene();
    scene.nodes.back().is_animated = true;
    scene::AnimationChannel channel;
    channel.node = static_cast<std::uint32_t>(scene.nodes.size() - 1);
    channel.path = scene::AnimationPath::kRotation;
    channel.times_s = {0.0F, 1.0F};
    channel.values = {glm::vec4(0, 0, 0, 1), glm::vec4(0, 1, 0, 0)}; // half a turn about y
    scene.channels.push_back(channel);
    scene.duration_s = 1.0;
    return scene;
}

using MovingSurfacesTest = RenderTest;

// A turning ball's reflection is static; only its surface moves. Measures the error of the reflection after 16 frames.
TEST_F(MovingSurfacesTest, ReflectionsDoNotTurnWithThem) {
    scene::Scene scene = turning_ball();
    scene::GpuScene gpu_scene(device(), scene, traversal());
    const Camera camera = look_at({0, 0, 2.6F}, {0, 0, 0}, 0.8F, kSize, kSize);
    const std::array wanted{PlaneSemantic::kSpecular};
    SourceRenderer exact(device(), gpu_scene);
    gpu_scene.pose(0, true);
    const auto truth = image::unpack_plane(exact.render(plain_header(camera, 1024)).download(wanted).planes.front());
    const auto error = [&](Denoiser denoiser) {
        SourceRenderer renderer(device(), gpu_scene);
        std::vector<glm::vec3> light;
        for (std::uint32_t frame = 0; frame < 16; ++frame) {
            FrameHeader header = plain_header(camera, 1);
            header.frame_id = header.noise_frame = frame;
            header.cut = frame == 0;
            header.scene_time_ns = frame * 20'000'000LL;
            header.settings.denoiser = denoiser;
            header.settings.temporal_accumulation = true;
            gpu_scene.pose(header.scene_time_ns, header.cut);
            light = image::unpack_plane(renderer.render(header).download(wanted).planes.front());
        }
        double sum = 0.0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            const double difference = static_cast<double>(light[i].y) - static_cast<double>(truth[i].y);
            sum += difference * difference;
        }
        return std::sqrt(sum / static_cast<double>(light.size()));
    };
    const double plain = error(Denoiser::kSvgf);
    const double following = error(Denoiser::kSvgfPlus);
    RecordProperty("svgf", std::to_string(plain));
    RecordProperty("svgf_plus", std::to_string(following));
    EXPECT_LT(following, 0.6 * plain);
}

INSTANTIATE_TEST_SUITE_P(Denoisers, SvgfTest, testing::Values(Denoiser::kSvgf, Denoiser::kSvgfPlus),
                         [](const auto& test) { return test.param == Denoiser::kSvgf ? "Svgf" : "SvgfPlus"; });

} // namespace
} // namespace fieldcast::render
