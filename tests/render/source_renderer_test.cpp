// SPDX-License-Identifier: Apache-2.0
// The source's history, and the planes that a client rebuilds.
#include "core/image/packing.h"
#include "tests/render/render_test.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 48;
constexpr std::uint32_t kHeight = 32;

using SourceRendererTest = RenderTest;

FrameHeader accumulating_header(const Camera& camera, std::uint64_t frame, std::uint32_t seed) {
    FrameHeader header = plain_header(camera, 1);
    header.frame_id = frame;
    header.noise_frame = static_cast<std::uint32_t>(frame);
    header.seed = seed;
    header.cut = frame == 0;
    header.settings.temporal_accumulation = true;
    return header;
}

std::vector<glm::vec3> diffuse_light(const SourcePlanes& planes) {
    const std::array wanted{PlaneSemantic::kDiffuse};
    return image::unpack_plane(planes.download(wanted).planes.front());
}

std::vector<std::uint32_t> ids(const SourcePlanes& planes) {
    const std::array wanted{PlaneSemantic::kId};
    const SourceFrame frame = planes.download(wanted);
    std::vector<std::uint32_t> result(frame.planes.front().bytes.size() / 4);
    std::memcpy(result.data(), frame.planes.front().bytes.data(), result.size() * 4);
    return result;
}

/// Variance of one image: the mean over pixels of half the squared difference of two images.
double variance_between(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = static_cast<double>(a[i].y) - static_cast<double>(b[i].y);
        sum += 0.5 * difference * difference;
    }
    return sum / static_cast<double>(a.size());
}

TEST_F(SourceRendererTest, AccumulationLowersTheVarianceAsItsAlphaSays) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    const Camera camera = room_camera(kWidth, kHeight);
    constexpr std::uint64_t kFrames = 20;
    std::array<std::vector<glm::vec3>, 2> first;
    std::array<std::vector<glm::vec3>, 2> last;
    for (std::uint32_t run = 0; run < 2; ++run) {
        SourceRenderer renderer(device(), gpu_scene);
        for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
            const SourcePlanes& planes = renderer.render(accumulating_header(camera, frame, 1 + run));
            (frame == 0 ? first : last)[run] = diffuse_light(planes);
        }
    }
    // Independent frames leave α / (2 − α) = 1/9 of one frame's variance. The frames continue each pixel's Sobol
    // sequence, which can only lower it; 40 % allow for heavy tails and the precision of the planes.
    const double ratio = variance_between(last[0], last[1]) / variance_between(first[0], first[1]);
    RecordProperty("variance_ratio", std::to_string(ratio));
    EXPECT_LT(ratio, 1.4 / 9.0);
    EXPECT_GT(ratio, 0.02); // 20 frames cannot go far below 1/20; the two images must still differ
}

TEST_F(SourceRendererTest, ACutForgetsAllHistory) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    const Camera camera = room_camera(kWidth, kHeight);
    SourceRenderer renderer(device(), gpu_scene);
    SourceRenderer fresh(device(), gpu_scene);
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
        renderer.render(accumulating_header(camera, frame, 1));
    }
    FrameHeader header = accumulating_header(camera, 4, 1);
    for (const Denoiser denoiser : {Denoiser::kNone, Denoiser::kSvgf, Denoiser::kSvgfPlus, Denoiser::kBmfr}) {
        header.settings.denoiser = denoiser;
        header.cut = true;
        const SourceFrame expected = fresh.render(header).download(kSourceSemantics);
        EXPECT_EQ(renderer.render(header).download(kSourceSemantics).planes, expected.planes);
    }
    header.cut = false; // without a cut the history is used
    header.frame_id = 5;
    header.noise_frame = 5;
    SourceRenderer newer(device(), gpu_scene);
    EXPECT_NE(renderer.render(header).download(kSourceSemantics).planes,
              newer.render(header).download(kSourceSemantics).planes);
}

TEST_F(SourceRendererTest, RendersTheSameFrameTwiceAlike) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer a(device(), gpu_scene);
    SourceRenderer b(device(), gpu_scene);
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        FrameHeader header = accumulating_header(room_camera(kWidth, kHeight), frame, 1);
        header.settings.denoiser = Denoiser::kSvgfPlus;
        EXPECT_EQ(a.render(header).download(kSourceSemantics).planes,
                  b.render(header).download(kSourceSemantics).planes);
    }
}

/// A room with a box that slides to the right by 0.1 m per 100 ms.
scene::Scene room_with_moving_box() {
    scene::Scene scene = area_lit_room();
    scene::Mesh mesh = box({}, glm::vec3(0.2F));
    mesh.material = 0;
    scene.meshes.push_back(mesh);
    scene::Node node;
    node.is_animated = true;
    scene.nodes.push_back(node);
    const auto index = static_cast<std::uint32_t>(scene.nodes.size() - 1);
    scene.instances.push_back({index, static_cast<std::uint32_t>(scene.meshes.size() - 1)});
    scene::AnimationChannel channel;
    channel.node = index;
    channel.times_s = {0.0F, 1.0F};
    channel.values = {glm::vec4(-0.4F, 0.2F, 0.8F, 0), glm::vec4(0.6F, 0.2F, 0.8F, 0)};
    scene.channels.push_back(channel);
    scene.duration_s = 1.0;
    return scene;
}

TEST_F(SourceRendererTest, WhatAMovingObjectUncoversHasNoHistory) {
    const scene::Scene scene = room_with_moving_box();
    scene::GpuScene gpu_scene(device(), scene, traversal());
    const Camera camera = room_camera(kWidth, kHeight);
    SourceRenderer renderer(device(), gpu_scene);
    SourceRenderer fresh(device(), gpu_scene);
    std::vector<std::uint32_t> before;
    std::size_t uncovered = 0;
    std::size_t followed = 0;
    for (std::uint64_t frame = 0; frame < 5; ++frame) {
        FrameHeader header = accumulating_header(camera, frame, 1);
        header.scene_time_ns = static_cast<std::int64_t>(frame) * 100'000'000;
        gpu_scene.pose(header.scene_time_ns, frame == 0);
        const SourcePlanes& planes = renderer.render(header);
        const std::vector<glm::vec3> light = diffuse_light(planes);
        const std::vector<std::uint32_t> now = ids(planes);
        header.cut = true;
        const std::vector<glm::vec3> alone = diffuse_light(fresh.render(header));
        const std::uint32_t box_id = static_cast<std::uint32_t>(scene.instances.size() - 1) << 12U;
        for (std::uint32_t y = 1; frame > 0 && y + 1 < kHeight; ++y) {
            for (std::uint32_t x = 1; x + 1 < kWidth; ++x) {
                const std::size_t i = std::size_t{y} * kWidth + x;
                std::set<std::uint32_t> around; // surfaces that the static camera saw around this pixel
                for (std::uint32_t k = 0; k < 9; ++k) {
                    around.insert(before[(y + k / 3 - 1) * kWidth + x + k % 3 - 1]);
                }
                if (now[i] != box_id && !around.contains(now[i])) {
                    EXPECT_EQ(light[i], alone[i]) << "frame " << frame << " pixel " << x << " " << y;
                    ++uncovered;
                }
                followed += now[i] == box_id && light[i] != alone[i] ? 1 : 0;
            }
        }
        before = now;
    }
    EXPECT_GT(uncovered, 5U);
    EXPECT_GT(followed, 100U); // the history follows the box
}

TEST_F(SourceRendererTest, RebuiltSurfacePlanesAreTheSourcesBits) {
    const scene::Scene scene = room_with_moving_box();
    scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer renderer(device(), gpu_scene);
    SurfacePlanesRenderer rebuilder(device(), gpu_scene);
    FrameHeader header = plain_header(room_camera(kWidth, kHeight), 1);
    header.guard_band = {3, 5, 2, 1};
    header.scene_time_ns = 300'000'000;
    gpu_scene.pose(header.scene_time_ns, true);
    const SourceFrame expected = renderer.render(header).download(kSourceSemantics);
    SourcePlanes planes(device());
    planes.resize(expected.header);
    rebuilder.render(planes);
    const std::array rebuilt{PlaneSemantic::kDepth, PlaneSemantic::kNormal, PlaneSemantic::kId,
                             PlaneSemantic::kMaterial};
    const SourceFrame actual = planes.download(rebuilt);
    for (const Plane& plane : actual.planes) {
        EXPECT_EQ(plane, *expected.find(plane.semantic)) << static_cast<int>(plane.semantic);
    }
}

TEST_F(SourceRendererTest, AveragesFramesWhileNothingMoves) {
    Stage s = stage(area_lit_room());
    const Camera camera = room_camera(32, 24);
    ViewRequest request = grid_request(camera, 2, 2, {{0.06F, 0.06F}});
    FrameHeader header = plain_header(camera, 1);
    header.settings.accumulate = true;
    header.settings.denoiser = Denoiser::kSvgfPlus;
    header.settings.temporal_accumulation = true;
    header.settings.indirect_clamp = 1.0F; // the clamp would remove light
    s.reference.start(camera);
    RenderSettings unbiased = plain_header(camera, 1024).settings;
    s.reference.accumulate(unbiased, 99);
    const std::vector<glm::vec3> expected = s.reference.image();
    const auto error = [&] { // RMS difference, and difference of the means, over the mean
        const LinearView view = s.grid.linear_view(0);
        double squared = 0.0;
        double sum = 0.0;
        double mean = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const double difference = view.pixels[i].y - expected[i].y;
            squared += difference * difference;
            sum += difference;
            mean += expected[i].y;
        }
        return glm::dvec2(std::sqrt(squared * static_cast<double>(expected.size())) / mean, std::abs(sum) / mean);
    };
    double first = 0.0;
    for (std::uint32_t frame = 0; frame <= 256; ++frame) {
        header.cut = frame == 0;
        header.noise_frame = frame;
        s.gpu_scene.pose(0, header.cut);
        const SourcePlanes& planes = s.source.render(header);
        EXPECT_EQ(planes.header().still_frames, frame); // the first frame is not known to be still
        s.grid.render(planes, request);
        first = frame == 1 ? error().x : first;
    }
    // 256 samples have a sixteenth of one sample's error. The reference's error adds an eighth of that, wire precision
    // (2^-7 in the worst case) the rest.
    EXPECT_LT(error().x, first / 16.0 * 1.3 + 0.008);
    EXPECT_LT(error().y, 0.01);

    header.source.world_from_camera[3].x += 0.01F;
    header.noise_frame = 257;
    s.gpu_scene.pose(0, false);
    EXPECT_EQ(s.source.render(header).header().still_frames, 0U);
}

/// Means of 4×4 pixels.
std::vector<glm::vec3> block_means(const std::vector<glm::vec3>& pixels, std::uint32_t width, std::uint32_t height) {
    std::vector<glm::vec3> means;
    for (std::uint32_t y = 0; y + 4 <= height; y += 4) {
        for (std::uint32_t x = 0; x + 4 <= width; x += 4) {
            glm::vec3 sum(0.0F);
            for (std::uint32_t i = 0; i < 16; ++i) {
                sum += pixels[std::size_t{y + i / 4} * width + x + i % 4];
            }
            means.push_back(sum / 16.0F);
        }
    }
    return means;
}

/// A floor under a wide lamp with an occluder in between, for direct light with soft shadows.
scene::Scene floor_under_a_lamp() {
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(box({0, 1, 0}, glm::vec3(0.3F)), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({0, 2, 0}, {1, 0, 0}, {0, 0, 1}), builder.add_material(emitter(glm::vec3(4.0F))));
    return builder.scene();
}

TEST_F(SourceRendererTest, NeighboursComplementOneAnother) {
    const scene::Scene scene = floor_under_a_lamp();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer renderer(device(), gpu_scene);
    const Camera camera = look_at({0, 1.5F, 3}, {0, 0, 0}, 0.7F, 64, 64);
    const auto light = [&](Sampler sampler, std::uint32_t seed) {
        FrameHeader header = plain_header(camera, 1);
        header.settings.max_bounces = 1;
        header.settings.sampler = sampler;
        header.seed = seed;
        return diffuse_light(renderer.render(header));
    };
    const auto variances = [&](Sampler sampler) { // variances of pixels and of blocks of pixels
        double pixels = 0.0;
        double blocks = 0.0;
        for (std::uint32_t run = 0; run < 4; ++run) {
            const auto a = light(sampler, 2 * run + 1);
            const auto b = light(sampler, 2 * run + 2);
            pixels += variance_between(a, b);
            blocks += variance_between(block_means(a, 64, 64), block_means(b, 64, 64));
        }
        return std::pair(pixels, blocks);
    };
    const auto alone = variances(Sampler::kSobol);
    const auto together = variances(Sampler::kZSobol);
    RecordProperty("alone", std::to_string(alone.second / alone.first));
    RecordProperty("together", std::to_string(together.second / together.first));
    EXPECT_NEAR(together.first / alone.first, 1.0, 0.15); // a single pixel is equally noisy
    EXPECT_NEAR(alone.second / alone.first, 1.0 / 16.0, 0.02);
    EXPECT_LT(together.second, 0.6 * alone.second);
}

/// Light of a frame of `samples` that replaces all history, after a frame of 512 samples with other random numbers.
std::vector<glm::vec3> light_after_a_good_frame(SourceRenderer& renderer, std::uint32_t samples, bool history_light,
                                                std::uint32_t max_bounces = 8) {
    FrameHeader header = plain_header(room_camera(kWidth, kHeight), 512);
    header.settings.temporal_accumulation = true;
    header.settings.temporal_alpha = 1.0F;
    header.cut = true;
    renderer.render(header);
    header.cut = false;
    header.frame_id = header.noise_frame = 1;
    header.settings.samples_per_pixel = samples;
    header.settings.max_bounces = max_bounces;
    header.settings.history_light = history_light;
    return diffuse_light(renderer.render(header));
}

/// Light of paths with more than one bounce. Paths of equal random numbers see equal light at their first surface.
std::vector<glm::vec3> indirect_after_a_good_frame(SourceRenderer& renderer, std::uint32_t samples,
                                                   bool history_light) {
    std::vector<glm::vec3> light = light_after_a_good_frame(renderer, samples, history_light);
    const std::vector<glm::vec3> direct = light_after_a_good_frame(renderer, samples, false, 1);
    std::ranges::transform(light, direct, light.begin(), std::minus<>());
    return light;
}

glm::dvec3 mean_of(const std::vector<glm::vec3>& light) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& pixel : light) {
        sum += glm::dvec3(pixel);
    }
    return sum / static_cast<double>(light.size());
}

TEST_F(SourceRendererTest, PathsThatEndInTheFrameBeforeHaveTheSameMeanAndLessNoise) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer renderer(device(), gpu_scene);
    const std::vector<glm::vec3> truth = light_after_a_good_frame(renderer, 512, false);
    // The means of 786,432 samples each are known to 0.1 %. The rest is light of the nearest pixel instead of the
    // point's, and paths that continue beyond eight bounces.
    const glm::dvec3 ratio = mean_of(light_after_a_good_frame(renderer, 512, true)) / mean_of(truth);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(ratio[c], 1.0, 0.005) << c; // the measured ratio is 1.0011
    }
    const std::vector<glm::vec3> indirect = indirect_after_a_good_frame(renderer, 512, false);
    const double without = variance_between(indirect_after_a_good_frame(renderer, 1, false), indirect);
    const double with = variance_between(indirect_after_a_good_frame(renderer, 1, true), indirect);
    RecordProperty("mean_ratio", std::to_string(ratio.y));
    RecordProperty("variance_ratio", std::to_string(with / without));
    EXPECT_LT(with, 0.8 * without); // measured 0.70; the directions of paths keep their noise
}

TEST_F(SourceRendererTest, PathsDoNotEndInAFrameBeforeACut) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    std::array<std::vector<glm::vec3>, 2> light;
    for (const bool history_light : {false, true}) {
        SourceRenderer renderer(device(), gpu_scene);
        FrameHeader header = accumulating_header(room_camera(kWidth, kHeight), 0, 1);
        header.settings.history_light = history_light;
        renderer.render(header);
        header.cut = true;
        header.noise_frame = 1;
        light[history_light ? 1 : 0] = diffuse_light(renderer.render(header));
    }
    EXPECT_EQ(light[0], light[1]);
}

TEST_F(SourceRendererTest, SamplersAgreeInTheMean) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer renderer(device(), gpu_scene);
    const auto mean = [&](Sampler sampler) {
        FrameHeader header = plain_header(room_camera(kWidth, kHeight), 512);
        header.settings.sampler = sampler;
        glm::dvec3 sum(0.0);
        for (const glm::vec3& pixel : diffuse_light(renderer.render(header))) {
            sum += glm::dvec3(pixel);
        }
        return sum;
    };
    const glm::dvec3 ratio = mean(Sampler::kZSobol) / mean(Sampler::kSobol);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(ratio[c], 1.0, 0.005); // 786,432 samples each have a standard error of 0.1 %
    }
}

} // namespace
} // namespace fieldcast::render
