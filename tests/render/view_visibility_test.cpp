// SPDX-License-Identifier: Apache-2.0
// Visibility of views must be the same from rays and from a rasteriser.
#include "core/render/camera_record.h"
#include "core/render/view_request.h"
#include "core/render/views/drawn_visibility.h"
#include "core/render/views/view_visibility.h"
#include "shaders/shared/scene.h"
#include "tests/render/render_test.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 201; // views are padded to multiples of four pixels
constexpr std::uint32_t kHeight = 113;
constexpr std::uint32_t kNothing = shared::kNoInstance;

using ViewVisibilityTest = RenderTest;

/// Visibility of the pixels of all views, one view after the other.
struct Seen {
    std::vector<glm::uvec2> solid; ///< (instance, primitive)
    std::vector<std::array<glm::uvec2, 2>> layers;
};

Seen look(const gpu::Device& device, const scene::GpuScene& scene, ViewVisibility& views,
          std::span<const Camera> cameras) {
    const std::uint64_t pixels = std::uint64_t{cameras[0].width_px} * cameras[0].height_px;
    const std::uint64_t padded = view_stride(cameras[0].width_px, cameras[0].height_px);
    const auto records = gpu::make_buffer<shared::CameraRecord>(device, make_camera_records(cameras));
    const gpu::Buffer visibility(device, padded * cameras.size() * 8);
    const gpu::Buffer layers(device, padded * cameras.size() * 16);
    gpu::CommandRecorder recorder(device);
    views.record(recorder, {cameras, records.address(), &visibility, &layers});
    recorder.submit();
    Seen seen;
    for (std::size_t view = 0; view < cameras.size(); ++view) {
        const auto solid = gpu::read_buffer_as<glm::uvec2>(device, visibility, pixels, 8 * padded * view);
        seen.solid.insert(seen.solid.end(), solid.begin(), solid.end());
        if (scene.has_blend()) {
            const auto two = gpu::read_buffer_as<std::array<glm::uvec2, 2>>(device, layers, pixels, 16 * padded * view);
            seen.layers.insert(seen.layers.end(), two.begin(), two.end());
        }
    }
    return seen;
}

Seen look(const gpu::Device& device, const scene::GpuScene& scene, std::span<const Camera> cameras) {
    ViewVisibility views(device, scene);
    return look(device, scene, views, cameras);
}

/// A material of squares, every other one cut out.
scene::Material cut_out(SceneBuilder& builder) {
    scene::Material material = diffuse(glm::vec3(1.0F));
    material.alpha_mode = scene::AlphaMode::kMask;
    material.base_colour.texture = builder.add_texture(2, {0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255});
    material.base_colour.uv_matrix = {glm::vec3(4, 0, 0), glm::vec3(0, 4, 0)};
    return material;
}

scene::Material veil() {
    scene::Material material = diffuse(glm::vec3(1.0F));
    material.alpha_mode = scene::AlphaMode::kBlend;
    return material;
}

/// A room that extends behind the camera. It has a finely divided sphere, a smaller mirror image of it, a lattice cut
/// out of a rectangle, and two veils in front of each other, one of which swings.
scene::Scene furnished_room() {
    SceneBuilder builder;
    const std::uint32_t wall = builder.add_material(diffuse(glm::vec3(0.5F)));
    builder.add(turned_inside_out(box({0, 0, 0}, {4, 2, 4})), wall);
    builder.add(sphere(0.7F, 48, Shading::kSmooth), wall, at({-0.8F, 0, -2.5F}));
    const glm::mat4 mirrored = glm::scale(at({0.9F, -0.8F, -2.2F}), {-0.4F, 0.4F, 0.4F});
    builder.add(sphere(0.7F, 48, Shading::kSmooth), wall, mirrored);
    builder.add(rectangle({1.2F, 0.5F, -3}, {0.8F, 0, 0}, {0, 0.8F, 0}), builder.add_material(cut_out(builder)));
    const std::uint32_t cloth = builder.add_material(veil());
    builder.add(rectangle({0, 0.3F, -1.5F}, {0.9F, 0, 0}, {0, 0.5F, 0}), cloth);
    const std::uint32_t swinging = builder.add(rectangle({0, 0, 0}, {0.4F, 0, 0}, {0, 0.6F, 0}), cloth);
    builder.slide(builder.scene().instances[swinging].node, {0.2F, 0, -1.2F}, {-0.6F, 0.1F, -1.2F});
    return builder.scene();
}

/// Ten views with off-axis frustums, which need two batches.
std::vector<Camera> ten_views() {
    const Camera middle = look_at({0, 0.1F, 0.5F}, {0, 0, -1}, 0.9F, kWidth, kHeight);
    std::vector<Camera> cameras;
    for (int i = 0; i < 10; ++i) {
        cameras.push_back(
            view_camera(middle, {{0.03F, 0.02F}, 3.0F}, {i - 5, 3 - i}, vertical_fov(middle), kWidth, kHeight));
    }
    return cameras;
}

/// Share of the elements that differ.
template <class T> double share_of_differences(const std::vector<T>& a, const std::vector<T>& b) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        differing += a[i] != b[i] ? 1U : 0U;
    }
    return static_cast<double>(differing) / static_cast<double>(a.size());
}

// A rasteriser moves vertices by up to half of 1/256 pixel. A pixel may then show the other side of an edge if its
// centre is that close. Most edges belong to the sphere's 2200 visible triangles of 3 pixels: they are 10 000 pixels
// long in an image of 22 713, which gives 10 000 / 256 / 22 713 = 0.17 %.
constexpr double kEdgeShare = 0.002;
// In an image of 40x90, a third shows the sphere. 2800 pixels of edges in 3600 give 2800 / 256 / 3600 = 0.3 %.
constexpr double kNarrowEdgeShare = 0.0035;

TEST_F(ViewVisibilityTest, DrawnViewsSeeWhatRaysMeet) {
    const scene::Scene scene = furnished_room();
    scene::GpuScene traced(device(), scene, traversal(), scene::VisibilityMethod::kRays);
    scene::GpuScene drawn(device(), scene, traversal(), scene::VisibilityMethod::kRaster);
    const std::vector<Camera> cameras = ten_views();
    std::vector<Seen> seen;
    for (const std::int64_t time_ns : {0LL, 700'000'000LL}) {
        SCOPED_TRACE(time_ns);
        traced.pose(time_ns, true);
        drawn.pose(time_ns, true);
        const Seen by_rays = look(device(), traced, cameras);
        const Seen by_raster = look(device(), drawn, cameras);
        EXPECT_LT(share_of_differences(by_rays.solid, by_raster.solid), kEdgeShare);
        EXPECT_LT(share_of_differences(by_rays.layers, by_raster.layers), kEdgeShare);
        for (std::uint32_t instance = 0; instance < 4; ++instance) { // every solid instance must be in the image
            EXPECT_TRUE(std::ranges::any_of(by_raster.solid, [&](glm::uvec2 s) { return s.x == instance; }))
                << instance;
        }
        for (std::size_t layer = 0; layer < 2; ++layer) {
            EXPECT_TRUE(std::ranges::any_of(by_raster.layers, [&](const auto& l) { return l[layer].x != kNothing; }));
        }
        seen.push_back(by_raster);
    }
    EXPECT_GT(share_of_differences(seen[0].layers, seen[1].layers), 0.1); // one of the veils must have moved
}

TEST_F(ViewVisibilityTest, PixelsThatSeeNothingSayso) {
    SceneBuilder builder;
    builder.add(rectangle({1, 0, -2}, {1, 0, 0}, {0, 5, 0}), builder.add_material(diffuse(glm::vec3(0.5F))));
    const scene::GpuScene scene(device(), builder.scene(), traversal(), scene::VisibilityMethod::kRaster);
    const Camera camera = look_at({}, {0, 0, -1}, 0.5F, 64, 32);
    const Seen seen = look(device(), scene, std::span(&camera, 1));
    for (std::size_t pixel = 0; pixel < seen.solid.size(); ++pixel) {
        EXPECT_EQ(seen.solid[pixel].x, pixel % 64 < 32 ? kNothing : 0U) << pixel;
    }
}

TEST_F(ViewVisibilityTest, OtherSizesFollowEachOther) {
    const scene::Scene scene = furnished_room();
    const scene::GpuScene drawn(device(), scene, traversal(), scene::VisibilityMethod::kRaster);
    const scene::GpuScene traced(device(), scene, traversal(), scene::VisibilityMethod::kRays);
    ViewVisibility views(device(), drawn);
    for (const std::uint32_t width : {160U, 40U, 320U}) {
        const Camera camera = look_at({0, 0.1F, 0.5F}, {0, 0, -1}, 0.9F, width, 90);
        const Seen by_raster = look(device(), drawn, views, std::span(&camera, 1));
        const Seen by_rays = look(device(), traced, std::span(&camera, 1));
        EXPECT_LT(share_of_differences(by_rays.solid, by_raster.solid), kNarrowEdgeShare) << width;
    }
}

TEST_F(ViewVisibilityTest, SmallPicturesOfManyTrianglesAreTraced) {
    SceneBuilder builder;
    builder.add(sphere(0.7F, 200, Shading::kSmooth), builder.add_material(diffuse(glm::vec3(0.5F))), at({0, 0, -2}));
    const scene::GpuScene scene(device(), builder.scene(), traversal(), scene::VisibilityMethod::kFaster);
    const DrawnVisibility drawn(device(), scene, *scene.draw_geometry());
    const auto is_fast = [&](std::uint32_t width, std::uint32_t height, const glm::vec3& target) {
        const Camera camera = look_at({}, target, 0.9F, width, height);
        return drawn.is_fast({std::span(&camera, 1), 0, nullptr, nullptr});
    };
    EXPECT_FALSE(is_fast(64, 36, {0, 0, -1})); // 2304 pixels for 40 000 triangles
    EXPECT_TRUE(is_fast(640, 360, {0, 0, -1}));
    EXPECT_TRUE(is_fast(64, 36, {0, 0, 1})); // the camera looks away from the triangles
}

} // namespace
} // namespace fieldcast::render
