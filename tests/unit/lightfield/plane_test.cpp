// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/plane.h"

#include "core/lightfield/source_frame.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

TEST(Plane, BytesFollowTheFormat) {
    EXPECT_EQ(plane_bytes(PlaneFormat::kR11G11B10F, 3, 2), 24U);
    EXPECT_EQ(plane_bytes(PlaneFormat::kRgb8, 3, 2), 18U);
    EXPECT_EQ(plane_bytes(PlaneFormat::kRg8, 3, 2), 12U);
    EXPECT_EQ(plane_bytes(PlaneFormat::kF32, 0, 2), 0U);
}

TEST(Plane, BytesDoNotOverflow) {
    EXPECT_EQ(plane_bytes(PlaneFormat::kU32, 0x80000000U, 0x40000000U), std::uint64_t{1} << 63);
}

TEST(Plane, UnknownFormatsHaveNoSize) {
    for (const int value : {0, 7, 255}) {
        EXPECT_EQ(bytes_per_pixel(static_cast<PlaneFormat>(value)), 0U);
    }
}

TEST(SourceFrame, IlluminationHasPagesOfLayers) {
    FrameHeader header;
    header.source.width_px = 8;
    header.source.height_px = 6;
    header.layer_count = kMaxLayers;
    for (const PlaneSemantic semantic :
         {PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular, PlaneSemantic::kTotalLight}) {
        EXPECT_EQ(plane_height(header, semantic), 3U * 6) << static_cast<int>(semantic);
    }
    EXPECT_EQ(plane_height(header, PlaneSemantic::kNormal), 6U);
}

TEST(SourceFrame, FindsPlanesByMeaning) {
    SourceFrame frame;
    frame.planes = {{PlaneSemantic::kDepth, PlaneFormat::kF32, 1, 1, {}},
                    {PlaneSemantic::kId, PlaneFormat::kU32, 1, 1, {}}};
    EXPECT_EQ(frame.find(PlaneSemantic::kId), &frame.planes[1]);
    EXPECT_EQ(frame.find(PlaneSemantic::kNormal), nullptr);
}

} // namespace
} // namespace fieldcast
