// SPDX-License-Identifier: Apache-2.0
// Compares views that reuse a source with the same views path traced without reuse.
#include "core/image/packing.h"
#include "core/lightfield/sources.h"
#include "core/render/setup.h"
#include "core/scene/gltf/loader.h"
#include "tests/render/render_test.h"

#include <cmath>
#include <cstring>
#include <filesystem>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;
constexpr float kSpacing = 0.06F; // metres; about 1.5 px of disparity per step at the boxes

class GridRendererTest : public RenderTest {};

std::uint32_t discarded(const Views& views) {
    std::uint32_t sum = 0;
    for (const View& view : views.views) {
        sum += view.discards.total();
    }
    return sum;
}

/// Largest difference of the means of 8×8 blocks, over the greater of the block's and the image's mean; and relative
/// difference of the whole image.
struct Difference {
    double worst_block = 0.0;
    double whole = 0.0;
};

Difference compare(const std::vector<glm::vec3>& pixels, const std::vector<glm::vec3>& reference, std::uint32_t width,
                   std::uint32_t height) {
    constexpr std::uint32_t kBlock = 8;
    Difference result;
    glm::dvec3 total(0.0);
    glm::dvec3 total_reference(0.0);
    double image_mean = 0.0;
    for (const glm::vec3& pixel : reference) {
        image_mean += static_cast<double>(pixel.y) / static_cast<double>(reference.size());
    }
    for (std::uint32_t y = 0; y + kBlock <= height; y += kBlock) {
        for (std::uint32_t x = 0; x + kBlock <= width; x += kBlock) {
            glm::dvec3 sum(0.0);
            glm::dvec3 expected(0.0);
            for (std::uint32_t i = 0; i < kBlock * kBlock; ++i) {
                const std::size_t at = static_cast<std::size_t>(y + i / kBlock) * width + x + i % kBlock;
                sum += glm::dvec3(pixels[at]);
                expected += glm::dvec3(reference[at]);
            }
            total += sum;
            total_reference += expected;
            const double difference = std::abs(sum.y - expected.y) / (kBlock * kBlock);
            result.worst_block =
                std::max(result.worst_block, difference / std::max(expected.y / (kBlock * kBlock), image_mean));
        }
    }
    result.whole = std::abs(total.y - total_reference.y) / total_reference.y;
    return result;
}

TEST_F(GridRendererTest, TheSourcesOwnViewIsTheSourceRemodulated) {
    Stage s = stage(area_lit_room());
    const Camera camera = room_camera(kWidth, kHeight);
    const SourcePlanes& planes = s.source.render(plain_header(camera, 1));
    const Views views = s.grid.render(planes, {{}, vertical_fov(camera), kWidth, kHeight, {LatticePosition{}}});
    EXPECT_EQ(discarded(views), 0U);

    const SourceFrame frame = planes.download(kSourceSemantics);
    const std::vector<glm::vec3> light = image::unpack_plane(*frame.find(PlaneSemantic::kDiffuse));
    const std::vector<std::byte>& ids = frame.find(PlaneSemantic::kId)->bytes;
    const LinearView view = s.grid.linear_view(0);
    for (std::size_t i = 0; i < view.pixels.size(); ++i) {
        std::uint32_t id = 0;
        std::memcpy(&id, ids.data() + 4 * i, 4);
        glm::vec3 expected(0.0F);
        if (id != 0xFFFFFFFFU) {
            const scene::Material& material = s.scene.materials[id & 0xFFFU];
            expected = material.emissive_factor + light[i] * glm::vec3(material.base_colour_factor);
        }
        // Every tap hits the pixel's centre up to rounding of the projection, 1e-5 px. Neighbours can be 100 times
        // brighter at one sample per pixel. Half floats add 2^-11.
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(view.pixels[i][c], expected[c], expected[c] * 1e-3F + 2e-3F) << i;
        }
    }
}

TEST_F(GridRendererTest, SeveralSourcesShowMoreAndTheSameLight) {
    Stage s = stage(point_lit_room());
    const Camera camera = room_camera(kWidth, kHeight);
    const ViewRequest request = grid_request(camera, 6, 6, {{kSpacing, kSpacing}});
    FrameHeader header = plain_header(camera, 1);
    header.settings.max_bounces = 1; // direct light of a point light has no noise
    header.source_geometry = request.geometry;
    std::uint32_t before = 0;
    for (const char* sources : {"top-left", "diagonal", "corners"}) {
        SCOPED_TRACE(sources);
        header.source_positions = *parse_sources(sources, {6, 6, request.geometry});
        const SourcePlanes& planes = s.source.render(header);
        const Views views = s.grid.render(planes, request);
        const std::uint32_t now = discarded(views);
        EXPECT_LT(now, before == 0 ? kWidth * kHeight * 36 / 4 : before);
        before = now;
        for (const std::size_t index : {0UL, 14UL, 35UL}) {
            const LinearView view = s.grid.linear_view(index);
            s.reference.start(
                view_camera(camera, request.geometry, request.positions[index], vertical_fov(camera), kWidth, kHeight));
            s.reference.accumulate(header.settings, 1);
            const Difference difference = compare(view.pixels, s.reference.image(), kWidth, kHeight);
            EXPECT_LT(difference.worst_block, 1.0 / 8.0) << index; // as for one source below
            EXPECT_LT(difference.whole, 0.006) << index;
        }
    }
}

/// Parameters of the grid of a noiseless scene.
struct GridCase {
    const char* name;
    bool guard_band;
    LatticeGeometry geometry;
    std::uint32_t width_px;
    std::uint32_t height_px;
    float fov_share; ///< field of view over that of the source
};

TEST_F(GridRendererTest, ViewsOfANoiselessSceneEqualTheirReferences) {
    // With a point light and one bounce, one sample per pixel is exact, so every view can be checked.
    Stage s = stage(point_lit_room());
    const Camera camera = room_camera(kWidth, kHeight);
    const LatticeGeometry parallel{{kSpacing, kSpacing}};
    const LatticeGeometry sheared{{kSpacing, kSpacing}, 3.0F};
    for (const GridCase& test : {GridCase{"plain", false, parallel, kWidth, kHeight, 1.0F},
                                 GridCase{"guard_band", true, parallel, kWidth, kHeight, 1.0F},
                                 GridCase{"convergence", true, sheared, kWidth, kHeight, 1.0F},
                                 GridCase{"smaller", true, parallel, 48, 32, 0.8F}}) {
        SCOPED_TRACE(test.name);
        const ViewGrid grid{6, 6, test.geometry};
        FrameHeader header = plain_header(camera, 1);
        header.settings.max_bounces = 1;
        if (test.guard_band) {
            header.guard_band = measure_guard_band(device(), s.gpu_scene, camera, grid).band;
        }
        const float fov = vertical_fov(camera) * test.fov_share;
        const Views views = s.grid.render(s.source.render(header),
                                          {test.geometry, fov, test.width_px, test.height_px, lattice_positions(grid)});
        const double share = discarded(views) / (36.0 * test.width_px * test.height_px);
        // Most pixels must come from the source. Otherwise this compares path tracing with itself.
        EXPECT_LT(share, test.guard_band ? 0.10 : 0.16);
        Difference worst;
        for (std::size_t i = 0; i < views.views.size(); ++i) {
            s.reference.start(
                view_camera(camera, test.geometry, views.views[i].position, fov, test.width_px, test.height_px));
            s.reference.accumulate(header.settings, 1);
            const Difference difference =
                compare(s.grid.linear_view(i).pixels, s.reference.image(), test.width_px, test.height_px);
            worst.worst_block = std::max(worst.worst_block, difference.worst_block);
            worst.whole = std::max(worst.whole, difference.whole);
        }
        // Blocks: one pixel per row of 8 is wrong where a view uncovers the far side of a shadow's edge and the source
        // shows the near side only. Whole images: at most one block in twenty has such an edge. Elsewhere bilinear taps
        // blur without gain, and R11G11B10F rounds up as often as down.
        EXPECT_LT(worst.whole, 0.006);
        EXPECT_LT(worst.worst_block, 1.0 / 8.0);
        RecordProperty(test.name, "discarded " + std::to_string(share) + ", worst block " +
                                      std::to_string(worst.worst_block) + ", worst image " +
                                      std::to_string(worst.whole));
    }
}

TEST_F(GridRendererTest, ViewsOfAConvergedSourceEqualTheirReferences) {
    // With global illumination both images have noise.
    Stage s = stage(area_lit_room());
    constexpr std::uint32_t width = 32;
    constexpr std::uint32_t height = 24;
    const Camera camera = room_camera(width, height);
    const ViewGrid grid{6, 6, {{kSpacing, kSpacing}}};
    FrameHeader header = plain_header(camera, 256);
    header.guard_band = measure_guard_band(device(), s.gpu_scene, camera, grid).band;
    const SourcePlanes& planes = s.source.render(header);
    const std::vector<LatticePosition> positions{LatticePosition::whole(-2, -2), LatticePosition::whole(3, 3),
                                                 LatticePosition::whole(1, 0)};
    s.grid.render(planes, {grid.geometry, vertical_fov(camera), width, height, positions});
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Estimate reference =
            path_trace(s.scene, view_camera(camera, grid.geometry, positions[i], vertical_fov(camera), width, height),
                       {.samples = 32, .renders = 8});
        const LinearView view = s.grid.linear_view(i);
        for (std::uint32_t y = 0; y < height; y += 8) {
            for (std::uint32_t x = 0; x < width; x += 8) {
                glm::dvec3 mean(0.0);
                for (std::uint32_t k = 0; k < 64; ++k) {
                    mean += glm::dvec3(view.pixels[reference.index(x + k % 8, y + k / 8)]) / 64.0;
                }
                const Average expected = average(reference, x, y, 8, 8);
                // 36 blocks at 4.5 standard errors of the difference. The view's noise is √2 that of the reference,
                // because neighbours share taps. 2 % allow for edges and curvature between taps.
                EXPECT_NEAR(mean.y, expected.mean.y,
                            4.5 * std::sqrt(3.0) * expected.standard_error.y + 0.02 * expected.mean.y)
                    << "view " << i << " block " << x << " " << y;
            }
        }
    }
    EXPECT_EQ(s.grid.invalid_sample_count() + s.source.invalid_sample_count(), 0U);
}

TEST_F(GridRendererTest, IsDeterministicAndViewsDoNotDependOnTheirBatch) {
    Stage s = stage(area_lit_room());
    const Camera camera = room_camera(kWidth, kHeight);
    const LatticeGeometry geometry{{kSpacing, kSpacing}};
    const ViewRequest all = grid_request(camera, 6, 6, geometry);
    const SourcePlanes& planes = s.source.render(plain_header(camera, 1));
    const Views first = s.grid.render(planes, all);
    EXPECT_GT(discarded(first), 1000U); // only holes could differ
    std::vector<LinearView> linear;
    for (std::size_t i = 0; i < all.positions.size(); ++i) {
        linear.push_back(s.grid.linear_view(i));
    }
    const Views second = s.grid.render(planes, all);
    for (std::size_t i = 0; i < all.positions.size(); ++i) {
        EXPECT_EQ(first.views[i].image, second.views[i].image) << i;
        EXPECT_EQ(first.views[i].discards, second.views[i].discards) << i;
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{5}, std::size_t{14}, std::size_t{35}}) {
        ViewRequest one = all;
        one.positions = {all.positions[i]};
        const Views alone = s.grid.render(planes, one);
        EXPECT_EQ(s.grid.linear_view(0).pixels, linear[i].pixels) << i;
        EXPECT_EQ(alone.views[0].image, first.views[i].image) << i;
        EXPECT_EQ(alone.views[0].discards, first.views[i].discards) << i;
    }
}

TEST_F(GridRendererTest, DiscardsAreThePixelsThatArePathTraced) {
    // Two frames with different seeds differ exactly in the traced pixels, because every pixel's light has noise.
    Stage s = stage(sky_lit_room());
    const Camera camera = room_camera(kWidth, kHeight);
    const ViewRequest request = grid_request(camera, 3, 3, {{2 * kSpacing, 2 * kSpacing}});
    SourceFrame frame = s.source.render(plain_header(camera, 1)).download(kSourceSemantics);
    SourcePlanes planes(device());
    std::array<std::vector<LinearView>, 2> linear;
    std::array<Views, 2> views;
    for (std::uint32_t seed = 0; seed < 2; ++seed) {
        frame.header.seed = 100 + seed;
        frame.header.settings.samples_per_pixel = 8; // samples of the holes
        ASSERT_TRUE(planes.upload(frame).has_value());
        views[seed] = s.grid.render(planes, request);
        for (std::size_t i = 0; i < request.positions.size(); ++i) {
            linear[seed].push_back(s.grid.linear_view(i));
        }
    }
    for (std::size_t i = 0; i < request.positions.size(); ++i) {
        std::uint32_t changed = 0;
        for (std::size_t k = 0; k < linear[0][i].pixels.size(); ++k) {
            changed += linear[0][i].pixels[k] != linear[1][i].pixels[k] ? 1U : 0U;
        }
        const std::uint32_t total = views[0].views[i].discards.total();
        EXPECT_EQ(views[0].views[i].discards, views[1].views[i].discards);
        EXPECT_LE(changed, total) << i;
        // Two estimates of one pixel are equal only where all samples are black.
        EXPECT_GE(changed, static_cast<std::uint32_t>(0.9 * total)) << i;
    }
}

/// Compares the device's count of pixels out of the source's frustum with the count from the views' own depth.
void expect_out_of_frustum_agrees(RenderTest::Stage& s) {
    constexpr std::uint32_t width = 160;
    constexpr std::uint32_t height = 90;
    const scene::CameraNode* node = scene::find_camera(s.scene);
    ASSERT_NE(node, nullptr);
    FrameHeader header = plain_header(source_camera(s.gpu_scene, *node, width, height), 1);
    header.settings.max_bounces = 1;
    ViewRequest request = grid_request(header.source, 6, 6, {glm::vec2(node->spacing_m.value_or(0.03F))});
    const Views views = s.grid.render(s.source.render(header), request);
    double gpu_total = 0.0;
    double cpu_total = 0.0;
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        const Camera camera =
            view_camera(header.source, request.geometry, request.positions[i], request.fovy_rad, width, height);
        const std::vector<float> depth = s.grid.view_depth(i);
        std::uint32_t outside = 0;
        for (std::size_t k = 0; k < depth.size(); ++k) {
            if (!std::isfinite(depth[k])) {
                continue; // sky is evaluated, not reprojected
            }
            const glm::vec2 pixel(static_cast<float>(k % width) + 0.5F, static_cast<float>(k / width) + 0.5F);
            const glm::vec3 p = project(header.source, unproject(camera, pixel, depth[k]));
            outside += p.x < 0.0F || p.y < 0.0F || p.x >= width || p.y >= height ? 1U : 0U;
        }
        const double share = 100.0 / (width * height);
        // Per cent of all pixels. Only rounding at the border may differ.
        EXPECT_NEAR(views.views[i].discards.out_of_frustum * share, outside * share, 0.3) << i;
        gpu_total += views.views[i].discards.out_of_frustum * share / 36.0;
        cpu_total += outside * share / 36.0;
    }
    EXPECT_GT(gpu_total, 0.5); // per cent of all pixels; there must be pixels to count
    testing::Test::RecordProperty("out_of_frustum_percent",
                                  std::to_string(gpu_total) + " cpu " + std::to_string(cpu_total));
    EXPECT_EQ(s.grid.invalid_sample_count() + s.source.invalid_sample_count(), 0U);
}

class AtelierTest : public GridRendererTest {
protected:
    scene::Scene atelier_ = scene::load_scene("scenes/atelier/atelier.gltf");
};

TEST_F(AtelierTest, OutOfFrustumCountsAgreeWithTheViewsDepth) {
    Stage s = stage(atelier_);
    expect_out_of_frustum_agrees(s);
}

TEST_F(AtelierTest, HasNoInvalidSamplesOverSeveralFrames) {
    Stage s = stage(atelier_);
    for (std::uint64_t frame = 0; frame < 6; ++frame) {
        FrameHeader header;
        header.frame_id = frame;
        header.noise_frame = static_cast<std::uint32_t>(frame);
        header.scene_time_ns = static_cast<std::int64_t>(frame) * 500'000'000;
        header.cut = frame == 0;
        header.seed = 11;
        s.gpu_scene.pose(header.scene_time_ns, header.cut);
        header.source = source_camera(s.gpu_scene, *scene::find_camera(atelier_), 128, 72);
        s.grid.render(s.source.render(header), grid_request(header.source, 2, 2, {{0.1F, 0.1F}}));
        for (const glm::vec3& pixel : s.grid.linear_view(0).pixels) {
            ASSERT_TRUE(std::isfinite(pixel.x + pixel.y + pixel.z));
        }
    }
    EXPECT_EQ(s.grid.invalid_sample_count() + s.source.invalid_sample_count(), 0U);
}

/// Scenes of the shared folder; skipped on machines without them.
class SharedSceneTest : public GridRendererTest, public testing::WithParamInterface<const char*> {};

std::filesystem::path shared_scene(const std::string& folder_name) {
    const std::filesystem::path folder = std::filesystem::path("../shared/scenes") / folder_name;
    if (std::filesystem::is_directory(folder)) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            const auto extension = entry.path().extension();
            if (extension == ".gltf" || extension == ".glb") {
                return entry.path();
            }
        }
    }
    return {};
}

TEST_P(SharedSceneTest, HasNoInvalidSamples) {
    const std::filesystem::path file = shared_scene(GetParam());
    if (file.empty()) {
        GTEST_SKIP() << GetParam() << " is not here";
    }
    Stage s = stage(scene::load_scene(file));
    const scene::CameraNode* node = scene::find_camera(s.scene);
    const Camera camera =
        node != nullptr ? source_camera(s.gpu_scene, *node, 96, 54) : look_at({0, 1.5F, 0}, {1, 1.5F, 0}, 0.9F, 96, 54);
    s.grid.render(s.source.render(plain_header(camera, 2)), grid_request(camera, 2, 2, {{0.1F, 0.1F}}));
    EXPECT_EQ(s.grid.invalid_sample_count() + s.source.invalid_sample_count(), 0U);
}

TEST_P(SharedSceneTest, OutOfFrustumCountsAgreeWithTheViewsDepth) {
    const std::filesystem::path file = shared_scene(GetParam());
    if (file.empty()) {
        GTEST_SKIP() << GetParam() << " is not here";
    }
    Stage s = stage(scene::load_scene(file));
    expect_out_of_frustum_agrees(s);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SharedSceneTest, testing::Values("sponza", "breakfast_room", "gas_station"),
                         [](const auto& test) { return std::string(test.param); });

} // namespace
} // namespace fieldcast::render
