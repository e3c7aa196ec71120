// SPDX-License-Identifier: Apache-2.0
// The residual layer of frames for clients without the scene: tiles whose number differs from frame to frame.
#include "core/wire/convert.h"
#include "core/wire/encode.h"

#include "tests/wire/test_frames.h"

#include <array>
#include <functional>
#include <gmock/gmock.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

FrameHeader residual_header(std::uint64_t frame_id, std::vector<std::uint32_t> tiles) {
    FrameHeader header = test_header(frame_id);
    header.inverse_depth_unit = 0.25F;
    header.residual.positions = {LatticePosition::whole(-2, -2), LatticePosition{3, 5}};
    header.residual.geometry = {.spacing_m = {0.02F, 0.03F}, .convergence_m = 2.0F};
    header.residual.tiles = std::move(tiles);
    return header;
}

Plane plane_for(const FrameHeader& header, PlaneSemantic semantic, std::uint32_t seed) {
    Plane plane =
        ramp_plane(usual_format(semantic), plane_width(header, semantic), plane_height(header, semantic), seed);
    plane.semantic = semantic;
    return plane;
}

constexpr std::array kWarpPlanes{PlaneSemantic::kColour, PlaneSemantic::kInverseDepth, PlaneSemantic::kResidualColour,
                                 PlaneSemantic::kResidualInverseDepth};

SourceFrame residual_frame(std::uint64_t frame_id, std::vector<std::uint32_t> tiles) {
    SourceFrame frame{residual_header(frame_id, std::move(tiles)), {}};
    for (const PlaneSemantic semantic : kWarpPlanes) {
        frame.planes.push_back(plane_for(frame.header, semantic, 1)); // every frame alike: strips repeat where they may
    }
    return frame;
}

std::vector<PlaneChoice> choices() {
    std::vector<PlaneChoice> choices;
    for (const PlaneSemantic semantic : kWarpPlanes) {
        choices.push_back({semantic, {}});
    }
    return choices;
}

std::string header_problem(const std::function<void(v1::FrameHeader&)>& spoil) {
    v1::FrameHeader message;
    to_proto(residual_header(1, {0, 1, 100}), message);
    spoil(message);
    const auto read = from_proto(message, 1);
    return read ? "" : read.error().message;
}

TEST(ResidualLayer, HeaderComesBackAsItWas) {
    const FrameHeader header = residual_header(7, {0, 3, 4, 200}); // two views of 7 × 17 tiles
    v1::FrameHeader message;
    to_proto(header, message);
    EXPECT_THAT(message.residual().gaps(), ::testing::ElementsAre(0, 2, 0, 195));
    const auto read = from_proto(message, 7);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, header);
}

TEST(ResidualLayer, HeaderIsCheckedByField) {
    EXPECT_EQ(header_problem([](v1::FrameHeader&) {}), "");
    const auto residual_problem = [](const std::function<void(v1::ResidualLayer&)>& spoil) {
        return header_problem([&](v1::FrameHeader& header) { spoil(*header.mutable_residual()); });
    };
    EXPECT_THAT(residual_problem([](auto& layer) { layer.add_gaps(200); }), HasSubstr("gaps: tile 301 of 238"));
    EXPECT_THAT(residual_problem([](auto& layer) { layer.add_gaps(0xFFFFFFFF); }), HasSubstr("gaps"));
    EXPECT_THAT(residual_problem([](auto& layer) {
                    for (int i = 0; i < 240; ++i) {
                        layer.add_gaps(0);
                    }
                }),
                HasSubstr("243 tiles, at most 238"));
    EXPECT_THAT(residual_problem([](auto& layer) { layer.clear_positions(); }), HasSubstr("positions"));
    EXPECT_THAT(residual_problem([](auto& layer) {
                    for (int i = 5; i < 9; ++i) {
                        layer.add_positions()->set_col_halves(i);
                    }
                }),
                HasSubstr("6 views, at most 4"));
    EXPECT_THAT(residual_problem([](auto& layer) { layer.set_spacing_x_m(-1.0F); }), HasSubstr("spacing"));
    EXPECT_THAT(header_problem([](auto& header) { header.set_inverse_depth_unit(-1.0F); }),
                HasSubstr("inverse_depth_unit"));
}

TEST(ResidualLayer, TilesMayDifferFromThoseOfTheKeyFrame) {
    WorkerPool pool(1);
    FrameAssembler assembler;
    assembler.begin_epoch(1, {.max_width_px = 1024});
    const SourceFrame key = residual_frame(1, {0, 1, 2});
    std::vector<std::uint32_t> many(200);
    for (std::uint32_t i = 0; i < many.size(); ++i) {
        many[i] = i; // two rows of tiles instead of one
    }
    const SourceFrame next = residual_frame(2, many);
    const EncodedSource encoded_key = encode_source(key, choices(), {.frame_id = 1}, pool);
    const auto first = add_all(assembler, all_chunks(source_chunks(encoded_key, choices(), {})));
    ASSERT_TRUE(first && *first);
    const EncodedSource encoded = encode_source(next, choices(), {.frame_id = 1, .source = &key}, pool);
    EXPECT_LT(encoded.find(choices()[0])->encoded_bytes(), 100U) << "colour repeats the key frame";
    const auto second = add_all(assembler, all_chunks(source_chunks(encoded, choices(), {})));
    ASSERT_TRUE(second && *second);
    const auto& received = std::get<SourceFrame>((*second)->content);
    EXPECT_EQ(received.header.residual, next.header.residual);
    EXPECT_EQ(received.planes, next.planes);
}

TEST(ResidualLayer, StaysAwayFromClientsWithoutItsPlanes) {
    WorkerPool pool(1);
    const SourceFrame frame = residual_frame(1, {0, 1, 2});
    const std::vector<PlaneChoice> colour{choices()[0]};
    const WireFrame chunks = source_chunks(encode_source(frame, choices(), {}, pool), colour, {});
    EXPECT_FALSE(received(chunks.chunks.front()).header().has_residual());
}

TEST(ResidualLayer, PlanesNeedAStepOfInverseDepthAndTheSizeOfTheirTiles) {
    WorkerPool pool(1);
    for (const bool has_step : {false, true}) {
        FrameAssembler assembler;
        assembler.begin_epoch(1, {.max_width_px = 1024});
        const EncodedSource encoded = encode_source(residual_frame(1, {0}), choices(), {}, pool);
        auto chunks = all_chunks(source_chunks(encoded, choices(), {}));
        v1::FrameHeader& header = *chunks[0].mutable_header();
        header.set_inverse_depth_unit(has_step ? 0.25F : 0.0F);
        if (has_step) {
            header.mutable_planes()->mutable_planes(2)->set_height_px(16);
        }
        const auto added = add_all(assembler, chunks);
        ASSERT_FALSE(added);
        EXPECT_THAT(added.error().message, HasSubstr(has_step ? "size" : "inverse_depth_unit"));
    }
}

} // namespace
} // namespace fieldcast::wire
