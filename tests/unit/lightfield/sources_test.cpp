// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/source_frame.h"
#include "core/lightfield/sources.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

using Positions = std::vector<LatticePosition>;

TEST(Sources, ConfigurationsOfThePaper) {
    const ViewGrid grid; // 6×6: views (0,0) … (5,5) are lattice rows and columns −2 … 3
    const LatticePosition top_left = LatticePosition::whole(-2, -2);
    const LatticePosition top_right = LatticePosition::whole(-2, 3);
    const LatticePosition bottom_left = LatticePosition::whole(3, -2);
    const LatticePosition bottom_right = LatticePosition::whole(3, 3);
    EXPECT_EQ(parse_sources("middle", grid), Positions{LatticePosition{}});
    EXPECT_EQ(parse_sources("top-left", grid), Positions{top_left});
    EXPECT_EQ(parse_sources("diagonal", grid), (Positions{top_left, bottom_right}));
    EXPECT_EQ(parse_sources("triangle", grid), (Positions{top_left, top_right, LatticePosition::whole(3, 0)}));
    EXPECT_EQ(parse_sources("corners", grid), (Positions{top_left, top_right, bottom_left, bottom_right}));
}

TEST(Sources, CornersOfASweepAreItsEnds) {
    const auto sweep = parse_grid("1x45");
    ASSERT_TRUE(sweep);
    EXPECT_EQ(parse_sources("corners", *sweep),
              (Positions{LatticePosition::whole(0, -22), LatticePosition::whole(0, 22)}));
}

TEST(Sources, ListsNameViews) {
    const ViewGrid grid;
    EXPECT_EQ(parse_sources("2,2", grid), Positions{LatticePosition{}});
    EXPECT_EQ(parse_sources("0,5;3,1", grid),
              (Positions{LatticePosition::whole(-2, 3), LatticePosition::whole(1, -1)}));
    for (const char* wrong : {"", "left", "1", "1,", ",1", "1,1;", "1,1;;2,2", "6,0", "0,6", "1,1;1,1", "1,1 2,2",
                              "-1,0", "99999999999,0", "0,0;0,1;0,2;0,3;0,4;0,5;1,0;1,1;1,2"}) {
        EXPECT_FALSE(parse_sources(wrong, grid)) << wrong;
    }
}

TEST(Sources, CamerasAreThoseOfTheViews) {
    FrameHeader header;
    header.source = make_camera(glm::mat4(1.0F), 0.8F, 40, 30);
    header.source_positions = {{-4, 2}, {0, 0}};
    header.source_geometry = {{0.1F, 0.2F}, 3.0F};
    const Camera view =
        view_camera(header.source, header.source_geometry, {-4, 2}, vertical_fov(header.source), 40, 30);
    const Camera source = widened_source(header, 0);
    EXPECT_EQ(source.world_from_camera, view.world_from_camera);
    EXPECT_NEAR(source.principal_px.x, view.principal_px.x, 1e-4F); // the field of view is rounded on its way
    EXPECT_NEAR(source.principal_px.y, view.principal_px.y, 1e-4F);
    EXPECT_EQ(widened_source(header, 1), header.source);
}

TEST(Sources, PlanesStackSourcesThenLayers) {
    FrameHeader header;
    header.source = make_camera(glm::mat4(1.0F), 0.8F, 40, 30);
    header.source_positions = {{0, 0}, {0, 2}, {2, 0}};
    header.layer_count = 2;
    EXPECT_EQ(plane_height(header, PlaneSemantic::kDepth), 3U * 30U);
    EXPECT_EQ(plane_height(header, PlaneSemantic::kSpecular), 9U * 30U);
}

} // namespace
} // namespace fieldcast
