// SPDX-License-Identifier: Apache-2.0
// Compares views made from colour and depth with exact views of an analytic scene: a floor, a wall, and a card in front
// of it.
#include "core/render/warp/residual_tiles.h"
#include "core/render/warp/warp_planes.h"
#include "core/render/warp/warp_renderer.h"
#include "tests/gpu/gpu_test.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 160;
constexpr std::uint32_t kHeight = 96;
constexpr float kFloor_m = -1.0F;
constexpr float kWall_m = 8.0F; // view depth
constexpr float kCard_m = 2.5F;

enum Surface { kWall, kFloor, kCard };

struct Seen {
    Surface surface = kWall;
    float depth_m = 0.0F;
    glm::vec3 colour{0.0F}; // 0 … 255
};

/// Colour waves on every surface, at least 15 pixels long. Bilinear interpolation errs at their crests by at most
/// 100 · (2π / 15)² / 8 = 2.2.
glm::vec3 wave(const glm::vec2& at, float length_m) {
    const float phase = 2.0F * std::numbers::pi_v<float> / length_m;
    return 127.0F + 100.0F * glm::vec3(std::sin(phase * at.x), std::cos(phase * at.y), std::sin(phase * (at.x + at.y)));
}

Seen look(const Camera& camera, const glm::vec2& pixel) {
    const glm::vec3 origin(camera.world_from_camera[3]);
    const glm::vec3 ray = unproject(camera, pixel, 1.0F) - origin; // scaled to one metre of view depth
    const glm::vec3 at_card = origin + kCard_m * ray;
    if (std::abs(at_card.x) < 0.35F && std::abs(at_card.y - 0.1F) < 0.3F) {
        return {kCard, kCard_m, wave(glm::vec2(at_card), 0.5F) * glm::vec3(1.0F, 0.3F, 0.3F)};
    }
    const float floor_m = ray.y < 0.0F ? (kFloor_m - origin.y) / ray.y : kWall_m;
    if (floor_m < kWall_m) {
        const glm::vec3 at_floor = origin + floor_m * ray;
        return {kFloor, floor_m, wave({at_floor.x, at_floor.z}, 8.0F) * glm::vec3(0.3F, 1.0F, 0.3F)};
    }
    return {kWall, kWall_m, wave(glm::vec2(origin + kWall_m * ray), 1.5F) * glm::vec3(0.3F, 0.3F, 1.0F)};
}

Seen look(const Camera& camera, std::uint32_t x, std::uint32_t y) {
    return look(camera, glm::vec2(x, y) + 0.5F);
}

/// The planes of a camera's image.
struct Image {
    Plane colour;
    std::vector<float> depth_m;
};

Image photograph(const Camera& camera, PlaneSemantic semantic = PlaneSemantic::kColour) {
    Image image{{semantic, PlaneFormat::kRgb8, camera.width_px, camera.height_px, {}}, {}};
    for (std::uint32_t i = 0; i < camera.width_px * camera.height_px; ++i) {
        const Seen seen = look(camera, i % camera.width_px, i / camera.width_px);
        for (int c = 0; c < 3; ++c) {
            image.colour.bytes.push_back(static_cast<std::byte>(seen.colour[c] + 0.5F));
        }
        image.depth_m.push_back(seen.depth_m);
    }
    return image;
}

class WarpRendererTest : public gpu::GpuTest {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped()) {
            renderer_ = std::make_unique<WarpRenderer>(device());
        }
    }

    static ViewGrid grid() { return {6, 6, {.spacing_m = glm::vec2(0.05F)}}; }

    static FrameHeader header() {
        FrameHeader header;
        header.source = make_camera(glm::mat4(1.0F), 0.9F, kWidth, kHeight);
        header.guard_band = {10, 14, 10, 14};
        header.inverse_depth_unit = choose_inverse_depth_unit(header.source, grid(), 1.0F);
        return header;
    }

    static SourceFrame source_frame() {
        SourceFrame frame{header(), {}};
        const Camera camera = widened_source(frame.header, 0);
        Image image = photograph(camera);
        frame.planes = {std::move(image.colour), make_inverse_depth(PlaneSemantic::kInverseDepth, image.depth_m,
                                                                    camera.width_px, frame.header.inverse_depth_unit)};
        return frame;
    }

    static ViewRequest request(std::vector<LatticePosition> positions) {
        return {grid().geometry, vertical_fov(header().source), kWidth, kHeight, std::move(positions)};
    }

    static Camera camera_of(LatticePosition position) {
        return moved_camera(header().source, grid().geometry, position);
    }

    /// Adds the tiles of one view in which at least one pixel is hidden in the source.
    static void add_tiles(SourceFrame& frame, LatticePosition position, const std::vector<bool>& holes) {
        const Image image = photograph(camera_of(position), PlaneSemantic::kResidualColour);
        const std::vector<std::uint32_t> tiles = choose_tiles(holes, {kWidth, kHeight}, 1);
        TilePlane colour(PlaneSemantic::kResidualColour, PlaneFormat::kRgb8);
        TilePlane depth(PlaneSemantic::kResidualInverseDepth, PlaneFormat::kR16);
        colour.append(image.colour, tiles);
        depth.append(make_inverse_depth(PlaneSemantic::kResidualInverseDepth, image.depth_m, kWidth,
                                        frame.header.inverse_depth_unit),
                     tiles);
        frame.header.residual = {{position}, grid().geometry, tiles};
        frame.planes.push_back(colour.plane());
        frame.planes.push_back(depth.plane());
    }

    /// Largest error of a pixel's channels.
    static float error_at(const View& view, std::uint32_t x, std::uint32_t y) {
        const Seen truth = look(camera_of(view.position), x, y);
        float error = 0.0F;
        for (int c = 0; c < 3; ++c) {
            const std::size_t at = 3 * (std::size_t{y} * kWidth + x) + static_cast<std::size_t>(c);
            const auto value = static_cast<float>(std::to_integer<int>(view.image.bytes[at]));
            error = std::max(error, std::abs(value - truth.colour[c]));
        }
        return error;
    }

    /// Whether a pixel and its direct neighbours show one surface.
    static bool is_inner(const Camera& camera, std::uint32_t x, std::uint32_t y) {
        const Surface here = look(camera, x, y).surface;
        for (const glm::vec2 step : {glm::vec2(1, 0), glm::vec2(-1, 0), glm::vec2(0, 1), glm::vec2(0, -1)}) {
            if (look(camera, glm::vec2(x, y) + 0.5F + step).surface != here) {
                return false;
            }
        }
        return true;
    }

    /// Whether the source shows the surface of a view's pixel at its position and two pixels around it. True if it does
    /// everywhere (`wanted`) or nowhere (not `wanted`).
    static bool is_shown(const Camera& camera, std::uint32_t x, std::uint32_t y, bool wanted) {
        const Camera source = widened_source(header(), 0);
        const Seen seen = look(camera, x, y);
        const glm::vec3 at = project(source, unproject(camera, glm::vec2(x, y) + 0.5F, seen.depth_m));
        for (const glm::vec2 step :
             {glm::vec2(0), glm::vec2(2, 0), glm::vec2(-2, 0), glm::vec2(0, 2), glm::vec2(0, -2)}) {
            if ((look(source, glm::vec2(at) + step).surface == seen.surface) != wanted) {
                return false;
            }
        }
        return true;
    }

    std::unique_ptr<WarpRenderer> renderer_;
};

TEST_F(WarpRendererTest, ShowsWhatTheSourceShowsExactly) {
    const SourceFrame frame = source_frame();
    ASSERT_TRUE(renderer_->upload(frame));
    const Views views = renderer_->render(request(lattice_positions(grid())));
    ASSERT_EQ(views.views.size(), 36U);
    int checked = 0;
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        const Camera camera = camera_of(views.views[i].position);
        const std::vector<bool> holes = renderer_->hole_mask(i);
        for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; pixel += 7) {
            const std::uint32_t x = pixel % kWidth;
            const std::uint32_t y = pixel / kWidth;
            if (is_inner(camera, x, y) && is_shown(camera, x, y, true)) {
                ++checked;
                EXPECT_FALSE(holes[pixel]) << i << ": " << x << ", " << y;
                // interpolation 2.2 (see wave()), rounding of both images 0.5 each, 1/64 pixel of depth 0.7
                EXPECT_LE(error_at(views.views[i], x, y), 4.0F) << i << ": " << x << ", " << y;
            }
        }
    }
    EXPECT_GT(checked, 36 * 1500); // of about 2200 pixels sampled per view
}

TEST_F(WarpRendererTest, KnowsWhatTheSourceHides) {
    ASSERT_TRUE(renderer_->upload(source_frame()));
    renderer_->render(request({LatticePosition::whole(-2, 3), LatticePosition::whole(3, -2)}));
    int hidden = 0;
    for (const std::size_t i : {0U, 1U}) {
        const Camera camera = camera_of(i == 0 ? LatticePosition::whole(-2, 3) : LatticePosition::whole(3, -2));
        const std::vector<bool> holes = renderer_->hole_mask(i);
        for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
            if (look(camera, pixel % kWidth, pixel / kWidth).surface != kCard &&
                is_shown(camera, pixel % kWidth, pixel / kWidth, false)) {
                ++hidden;
                EXPECT_TRUE(holes[pixel]) << i << ": " << pixel % kWidth << ", " << pixel / kWidth;
            }
        }
        EXPECT_EQ(renderer_->counts()[i].extended(), std::ranges::count(holes, true));
        EXPECT_GT(renderer_->counts()[i].hidden, 0U);
    }
    EXPECT_GT(hidden, 50);
}

TEST_F(WarpRendererTest, GivesTheSourceBackUnchanged) {
    const SourceFrame frame = source_frame();
    ASSERT_TRUE(renderer_->upload(frame));
    const Views views = renderer_->render(request({LatticePosition{}}));
    const GuardBand band = frame.header.guard_band;
    const Plane& colour = *frame.find(PlaneSemantic::kColour);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        const std::size_t from = 3 * ((std::size_t{y} + band.top_px) * colour.width_px + band.left_px);
        const auto source_row = std::span(colour.bytes).subspan(from, std::size_t{3} * kWidth);
        const auto row =
            std::span(views.views[0].image.bytes).subspan(std::size_t{3} * kWidth * y, std::size_t{3} * kWidth);
        ASSERT_TRUE(std::ranges::equal(row, source_row)) << "row " << y;
    }
    EXPECT_EQ(renderer_->counts()[0].extended(), 0U);
}

TEST_F(WarpRendererTest, ExtendsWhatIsBehindAndNeverTheCard) {
    ASSERT_TRUE(renderer_->upload(source_frame()));
    const Views views = renderer_->render(request({LatticePosition::whole(-2, 3), LatticePosition::whole(3, 3)}));
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<bool> holes = renderer_->hole_mask(i);
        int reddish = 0;
        int count = 0;
        for (std::size_t pixel = 0; pixel < holes.size(); ++pixel) {
            const std::byte* const rgb = &views.views[i].image.bytes[3 * pixel];
            const auto channel = [&](int c) { return std::to_integer<int>(rgb[c]); };
            if (holes[pixel]) {
                ++count;
                EXPECT_GT(channel(0) + channel(1) + channel(2), 20) << "black at " << pixel; // surfaces are brighter
                const bool is_red = channel(0) > 3 * channel(1) && channel(0) > 3 * channel(2); // only the card is red
                reddish += is_red ? 1 : 0;
            }
        }
        ASSERT_GT(count, 20);
        EXPECT_LT(reddish, count / 10);
    }
}

TEST_F(WarpRendererTest, ResidualLayerShowsInnerViewsWhatTheSourceHides) {
    const LatticePosition corner = LatticePosition::whole(3, 3);
    const std::vector<LatticePosition> inner{LatticePosition::whole(1, 1), LatticePosition::whole(2, 2)};
    SourceFrame frame = source_frame();
    ASSERT_TRUE(renderer_->upload(frame));
    renderer_->render(request({corner}));
    const std::vector<bool> holes = renderer_->hole_mask(0);
    const Views without = renderer_->render(request(inner));
    std::vector<std::vector<bool>> hidden;
    std::uint32_t hidden_count = 0;
    for (std::size_t i = 0; i < inner.size(); ++i) {
        hidden.push_back(renderer_->hole_mask(i));
        hidden_count += renderer_->counts()[i].extended();
    }
    add_tiles(frame, corner, holes);
    ASSERT_TRUE(renderer_->upload(frame));
    const Views with = renderer_->render(request(inner));
    double error_without = 0.0;
    double error_with = 0.0;
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < inner.size(); ++i) {
        EXPECT_GT(renderer_->counts()[i].residual, 0U);
        left += renderer_->counts()[i].extended();
        for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
            if (hidden[i][pixel]) {
                error_without += error_at(without.views[i], pixel % kWidth, pixel / kWidth);
                error_with += error_at(with.views[i], pixel % kWidth, pixel / kWidth);
            }
        }
    }
    ASSERT_GT(hidden_count, 50U);
    EXPECT_LT(left, hidden_count / 5); // pixels at edges remain
    EXPECT_LT(error_with, error_without / 3.0);
}

TEST_F(WarpRendererTest, MakesSmallerViewsAndOtherSpacings) {
    ASSERT_TRUE(renderer_->upload(source_frame()));
    ViewRequest wanted = request({LatticePosition::whole(1, 0)});
    wanted.width_px = kWidth / 2;
    wanted.height_px = kHeight / 2;
    wanted.geometry = {.spacing_m = glm::vec2(0.03F), .convergence_m = 4.0F};
    const Views views = renderer_->render(wanted);
    const Camera camera = view_camera(header().source, wanted.geometry, wanted.positions[0], wanted.fovy_rad,
                                      wanted.width_px, wanted.height_px);
    const Seen truth = look(camera, 40U, 12U);
    ASSERT_EQ(truth.surface, kWall);
    const std::size_t at = 3 * (12 * std::size_t{wanted.width_px} + 40);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(std::to_integer<int>(views.views[0].image.bytes[at + c]), truth.colour[static_cast<int>(c)], 4.0F);
    }
}

TEST_F(WarpRendererTest, RefusesFramesThatDoNotFit) {
    const auto problem = [&](const std::function<void(SourceFrame&)>& spoil) {
        SourceFrame frame = source_frame();
        spoil(frame);
        const auto taken = renderer_->upload(frame);
        return taken ? std::string() : taken.error().message;
    };
    using testing::HasSubstr;
    EXPECT_EQ(problem([](SourceFrame&) {}), "");
    EXPECT_THAT(problem([](SourceFrame& f) { f.planes.pop_back(); }), HasSubstr("INVERSE_DEPTH"));
    EXPECT_THAT(problem([](SourceFrame& f) { f.planes.erase(f.planes.begin()); }), HasSubstr("COLOUR"));
    EXPECT_THAT(problem([](SourceFrame& f) { f.planes[0].bytes.pop_back(); }), HasSubstr("COLOUR"));
    EXPECT_THAT(problem([](SourceFrame& f) { f.header.inverse_depth_unit = 0.0F; }), HasSubstr("inverse_depth_unit"));
    EXPECT_THAT(problem([](SourceFrame& f) { f.header.source_positions.push_back(LatticePosition::whole(1, 1)); }),
                HasSubstr("2 sources"));
    EXPECT_THAT(problem([](SourceFrame& f) { f.header.residual = {{LatticePosition::whole(1, 1)}, {}, {0}}; }),
                HasSubstr("RESIDUAL_COLOUR"));
}

} // namespace
} // namespace fieldcast::render
