// SPDX-License-Identifier: Apache-2.0
// Views made from one plane of illumination instead of two, and from normals with 8 bits per component.
#include "core/image/packing.h"
#include "core/lightfield/normal_precision.h"
#include "tests/render/render_test.h"

#include <algorithm>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 48;
constexpr std::uint32_t kHeight = 32;

class LightMergerTest : public RenderTest {
protected:
    /// A frame of `camera` as a client receives it.
    SourceFrame make_frame(Stage& s, const Camera& camera = room_camera(kWidth, kHeight)) {
        FrameHeader header = plain_header(camera, 8);
        header.guard_band = {3, 5, 2, 1};
        header.settings.reflections = false; // reflections would read light of other pixels
        return s.source.render(header).download(kSourceSemantics);
    }

    std::vector<glm::vec3> show(Stage& s, const SourceFrame& frame) {
        SourcePlanes planes(device());
        EXPECT_TRUE(planes.upload(frame).has_value());
        const LatticeGeometry geometry{{0.06F, 0.06F}};
        views_ =
            s.grid.render(planes, grid_request(frame.header.source, 2, 2, geometry)); // the first view is the source's
        return s.grid.linear_view(0).pixels;
    }

    std::uint32_t discards() const {
        std::uint32_t sum = 0;
        for (const View& view : views_.views) {
            sum += view.discards.total();
        }
        return sum;
    }

    Views views_;
};

TEST_F(LightMergerTest, TheSourceLooksTheSameFromOnePlane) {
    Stage s = stage(cornell_box()); // it has diffuse and metallic surfaces
    SourceFrame frame = make_frame(s, cornell_camera(kHeight));
    const Plane light = s.source.total_light();
    EXPECT_EQ(light.semantic, PlaneSemantic::kTotalLight);
    EXPECT_NE(light.bytes, frame.find(PlaneSemantic::kDiffuse)->bytes);
    EXPECT_NE(light.bytes, frame.find(PlaneSemantic::kSpecular)->bytes);
    const std::vector<glm::vec3> expected = show(s, frame);
    const std::uint32_t expected_discards = discards();
    std::erase_if(frame.planes, [](const Plane& plane) { return is_illumination(plane.semantic); });
    frame.planes.push_back(light);
    const std::vector<glm::vec3> shown = show(s, frame);
    EXPECT_EQ(discards(), expected_discards) << "light must not decide which pixels are reused";
    float brightest = 0.0F;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        for (int c = 0; c < 3; ++c) { // rounding to 6 mantissa bits (blue 5) errs by at most 2^-6, halves by 2^-11
            ASSERT_NEAR(shown[i][c], expected[i][c], expected[i][c] * 0.0166F + 1e-4F) << i;
            brightest = std::max(brightest, expected[i][c]);
        }
    }
    EXPECT_GT(brightest, 0.1F);
}

TEST_F(LightMergerTest, CoarseNormalsDiscardAboutTheSamePixels) {
    Stage s = stage(area_lit_room());
    SourceFrame frame = make_frame(s);
    show(s, frame);
    const std::uint32_t expected = discards();
    const auto normal = std::ranges::find(frame.planes, PlaneSemantic::kNormal, &Plane::semantic);
    *normal = coarse_normals(*normal);
    show(s, frame);
    // Lossy planes may cost 0.3 percentage points of the pixels (docs/measurements/codecs.md).
    EXPECT_NEAR(discards(), expected, 0.003 * 4 * kWidth * kHeight);
    SourcePlanes planes(device());
    ASSERT_TRUE(planes.upload(frame).has_value());
    const std::array wanted{PlaneSemantic::kNormal};
    EXPECT_EQ(planes.download(wanted).planes.front(), fine_normals(*normal));
    Plane wrong = *normal;
    wrong.semantic = PlaneSemantic::kMaterial;
    frame.planes.push_back(wrong);
    EXPECT_FALSE(planes.upload(frame).has_value());
}

} // namespace
} // namespace fieldcast::render
