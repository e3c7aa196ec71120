// SPDX-License-Identifier: Apache-2.0
#include "core/wire/frame_assembler.h"

#include "core/codec/light_curve.h"
#include "tests/wire/test_frames.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

class FrameAssemblerTest : public ::testing::Test {
protected:
    FrameAssemblerTest() { assembler_.begin_epoch(3, {}); }

    /// Chunks small enough that strips are split.
    std::vector<v1::FrameChunk> source_frame(std::uint64_t frame_id, std::uint32_t chunk_bytes = 150) {
        const auto choices = all_choices();
        const EncodedSource source = encode_source(test_source(frame_id), choices, {}, pool_);
        return all_chunks(source_chunks(source, choices, {.epoch = 3, .chunk_bytes = chunk_bytes}), times_);
    }

    std::vector<v1::FrameChunk> view_frame(const ViewGrid& grid) {
        const ViewFormat format{.geometry = grid.geometry, .fovy_rad = 0.7F, .width_px = 30, .height_px = 130};
        const EncodedViews views = encode_views(test_views(grid, 30, 130), format, {}, pool_);
        return all_chunks(view_chunks(views, grid, {.epoch = 3}), times_);
    }

    /// The whole frame must fail with that message, and the next one must be fine.
    void expect_failure(const std::vector<v1::FrameChunk>& chunks, const std::string& message) {
        const auto added = add_all(assembler_, chunks);
        ASSERT_FALSE(added) << message;
        EXPECT_THAT(added.error().message, HasSubstr(message));
        const auto next = add_all(assembler_, source_frame(++next_id_));
        ASSERT_TRUE(next) << next.error().message;
        EXPECT_TRUE(next->has_value());
    }

    const ServerTimes times_{1, 2, 3, 4, 5, 6, -7};
    WorkerPool pool_{3};
    FrameAssembler assembler_;
    std::uint64_t next_id_ = 1000;
};

TEST_F(FrameAssemblerTest, RestoresSourceFrames) {
    for (WorkerPool* pool : {static_cast<WorkerPool*>(nullptr), &pool_}) {
        FrameAssembler assembler(pool);
        assembler.begin_epoch(3, {});
        for (const std::uint64_t frame_id : {4U, 5U, 9U}) {
            const SourceFrame sent = test_source(frame_id);
            auto added = add_all(assembler, source_frame(frame_id));
            ASSERT_TRUE(added) << added.error().message;
            ASSERT_TRUE(*added);
            const auto& frame = std::get<SourceFrame>((*added)->content);
            EXPECT_TRUE(frame.header == sent.header);
            EXPECT_TRUE(frame.planes == sent.planes);
            EXPECT_EQ((*added)->epoch, 3U);
            EXPECT_TRUE((*added)->server_times == times_);
            EXPECT_EQ((*added)->header().frame_id, frame_id);
            EXPECT_GT((*added)->payload_bytes, 0U);
        }
    }
}

TEST_F(FrameAssemblerTest, LossyLightArrivesBesideLosslessPlanes) {
    SourceFrame sent = test_source(4);
    Plane& light = sent.planes.front();
    light = light_plane(light.width_px, light.height_px);
    std::vector<PlaneChoice> choices = all_choices();
    choices.front().encoding = {Codec::kJpeg, 90};
    const EncodedSource source = encode_source(sent, choices, {}, pool_);
    const auto& strip = *source.find(choices.front())->strips.front().best.bytes;
    const auto curve = codec::decode_curve(std::span(strip).subspan(codec::kStripHeaderBytes));
    ASSERT_TRUE(curve);
    const auto rows = std::span(light.bytes).first(std::size_t{4} * light.width_px * codec::kStripRows);
    EXPECT_EQ(*curve, codec::light_curve_for(rows, sent.header.settings.exposure));
    const auto added = add_all(assembler_, all_chunks(source_chunks(source, choices, {.epoch = 3}), times_));
    ASSERT_TRUE(added) << added.error().message;
    const auto& frame = std::get<SourceFrame>((*added)->content);
    EXPECT_TRUE(std::equal(frame.planes.begin() + 1, frame.planes.end(), sent.planes.begin() + 1));
    for (std::size_t i = 0; i < std::size_t{light.width_px} * light.height_px; ++i) {
        const int green = green_bits(light, i);
        EXPECT_NEAR(green_bits(frame.planes.front(), i), green, green == 0 ? 512 : 64) << i; // 64: an octave
    }
}

TEST_F(FrameAssemblerTest, RestoresViewsOfEveryAnchor) {
    for (const Anchor anchor : {Anchor::kLattice, Anchor::kCentre}) {
        assembler_.begin_epoch(3, {});
        const ViewGrid grid{.rows = 2, .cols = 3, .geometry = {{0.03F, 0.02F}, 1.5F}, .anchor = anchor};
        const Views sent = test_views(grid, 30, 130);
        auto added = add_all(assembler_, view_frame(grid));
        ASSERT_TRUE(added) << added.error().message;
        ASSERT_TRUE(*added);
        const auto& received = std::get<ReceivedViews>((*added)->content);
        EXPECT_TRUE(received.set == (ViewSet{grid, 30, 130, 0.7F}));
        EXPECT_TRUE((*added)->header() == sent.header);
        ASSERT_EQ(received.views.views.size(), 6U);
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(received.views.views[i].position, sent.views[i].position);
            EXPECT_TRUE(received.views.views[i].image == sent.views[i].image);
            EXPECT_TRUE(received.views.views[i].discards == sent.views[i].discards);
        }
    }
}

TEST_F(FrameAssemblerTest, WithoutDecodingPlanesAreNamedAndEmpty) {
    for (const Decoding decoding : {Decoding::kChecksum, Decoding::kHeaders}) {
        FrameAssembler assembler(nullptr, decoding);
        assembler.begin_epoch(3, {});
        auto added = add_all(assembler, source_frame(4));
        ASSERT_TRUE(added) << added.error().message;
        ASSERT_TRUE(*added);
        const SourceFrame sent = test_source(4);
        const auto& frame = std::get<SourceFrame>((*added)->content);
        EXPECT_TRUE(frame.header == sent.header);
        ASSERT_EQ(frame.planes.size(), sent.planes.size());
        for (std::size_t i = 0; i < sent.planes.size(); ++i) {
            EXPECT_EQ(frame.planes[i].semantic, sent.planes[i].semantic);
            EXPECT_EQ(frame.planes[i].height_px, sent.planes[i].height_px);
            EXPECT_TRUE(frame.planes[i].bytes.empty());
        }
        EXPECT_EQ((*added)->payload_bytes, (*add_all(assembler_, source_frame(4)))->payload_bytes);
    }
}

TEST_F(FrameAssemblerTest, WithoutDecodingMissingChunksAreNoticed) {
    const auto chunks = source_frame(1);
    for (std::size_t missing = 0; missing + 1 < chunks.size(); ++missing) {
        FrameAssembler assembler(nullptr, Decoding::kHeaders);
        assembler.begin_epoch(3, {});
        auto damaged = chunks;
        damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(missing));
        EXPECT_FALSE(add_all(assembler, damaged)) << missing;
    }
}

TEST_F(FrameAssemblerTest, OnlyHeaderDecodingLeavesDamageUnnoticed) {
    auto damaged = source_frame(1);
    damaged[1].mutable_payload()->back() ^= 1;
    for (const Decoding decoding : {Decoding::kChecksum, Decoding::kHeaders}) {
        FrameAssembler assembler(nullptr, decoding);
        assembler.begin_epoch(3, {});
        const auto added = add_all(assembler, damaged);
        EXPECT_EQ(added.has_value(), decoding == Decoding::kHeaders);
    }
}

TEST_F(FrameAssemblerTest, EveryMissingChunkIsNoticed) {
    const auto chunks = source_frame(1);
    for (std::size_t missing = 0; missing + 1 < chunks.size(); ++missing) {
        assembler_.begin_epoch(3, {});
        auto damaged = chunks;
        damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(missing));
        EXPECT_FALSE(add_all(assembler_, damaged)) << missing;
    }
}

TEST_F(FrameAssemblerTest, EveryMissingChunkIsNoticedEvenWithRightIndices) {
    const auto chunks = source_frame(1);
    for (std::size_t missing = 1; missing + 1 < chunks.size(); ++missing) {
        assembler_.begin_epoch(3, {});
        auto damaged = chunks;
        damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(missing));
        for (std::size_t i = 0; i < damaged.size(); ++i) {
            damaged[i].set_index(static_cast<std::uint32_t>(i));
        }
        EXPECT_FALSE(add_all(assembler_, damaged)) << missing;
    }
}

TEST_F(FrameAssemblerTest, DuplicatesAndSwapsAreNoticed) {
    const auto chunks = source_frame(1);
    for (std::size_t at = 0; at + 1 < chunks.size(); ++at) {
        assembler_.begin_epoch(3, {});
        auto twice = chunks;
        twice.insert(twice.begin() + static_cast<std::ptrdiff_t>(at), chunks[at]);
        EXPECT_FALSE(add_all(assembler_, twice)) << at;
        assembler_.begin_epoch(3, {});
        auto swapped = chunks;
        std::swap(swapped[at], swapped[at + 1]);
        EXPECT_FALSE(add_all(assembler_, swapped)) << at;
    }
}

TEST_F(FrameAssemblerTest, DamagedPayloadFailsAndTheNextFrameIsFine) {
    auto chunks = source_frame(1);
    chunks.back().mutable_trailer()->set_crc32c(chunks.back().trailer().crc32c() ^ 1);
    expect_failure(chunks, "crc32c");
    chunks = source_frame(next_id_ += 1, kDefaultChunkBytes);
    chunks[1].mutable_payload()->at(0) = 9;
    expect_failure(chunks, "version 9");
}

TEST_F(FrameAssemblerTest, RawDamageIsCaughtByTheCrc) {
    const std::vector<PlaneChoice> choices{{PlaneSemantic::kId, {Codec::kRaw}}};
    const EncodedSource source = encode_source(test_source(1), choices, {}, pool_);
    auto chunks = all_chunks(source_chunks(source, choices, {.epoch = 3}));
    chunks[1].mutable_payload()->back() ^= 1;
    expect_failure(chunks, "crc32c");
}

TEST_F(FrameAssemblerTest, WrongFrameIdsAndEpochs) {
    auto chunks = source_frame(1);
    chunks[2].set_frame_id(77);
    expect_failure(chunks, "without header");
    chunks = source_frame(++next_id_);
    chunks[2].set_epoch(2);
    expect_failure(chunks, "epoch 2");
    expect_failure(source_frame(5), "must grow");
    chunks = source_frame(++next_id_);
    chunks[0].set_index(1);
    expect_failure(chunks, "index above 0");
}

TEST_F(FrameAssemblerTest, BeforeTheFirstEpochNothingIsTaken) {
    FrameAssembler fresh;
    EXPECT_FALSE(add_all(fresh, source_frame(1)));
    auto chunk = source_frame(2)[0];
    chunk.set_epoch(0);
    EXPECT_FALSE(fresh.add(chunk));
}

TEST_F(FrameAssemblerTest, AbortedFramesAreSkipped) {
    const auto aborted = source_frame(1);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(assembler_.add(aborted[i]));
    }
    assembler_.abort(1);
    for (std::size_t i = 3; i < aborted.size(); ++i) {
        const auto added = assembler_.add(aborted[i]);
        ASSERT_TRUE(added);
        EXPECT_FALSE(*added);
    }
    auto next = add_all(assembler_, source_frame(2));
    ASSERT_TRUE(next) << next.error().message;
    EXPECT_TRUE(*next);
    assembler_.abort(2); // too late: harmless
    EXPECT_TRUE(add_all(assembler_, source_frame(3))->has_value());
}

TEST_F(FrameAssemblerTest, AFrameInsideAnotherFailsBoth) {
    const auto first = source_frame(1);
    ASSERT_TRUE(assembler_.add(first[0]));
    const auto added = assembler_.add(source_frame(2)[0]);
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message, HasSubstr("begins before frame 1 was completed"));
    EXPECT_FALSE(assembler_.add(first[1]));
    EXPECT_TRUE(add_all(assembler_, source_frame(3))->has_value());
}

TEST_F(FrameAssemblerTest, ANewEpochDropsTheUnfinishedFrame) {
    ASSERT_TRUE(assembler_.add(source_frame(8)[0]));
    assembler_.begin_epoch(3, {});
    EXPECT_TRUE(add_all(assembler_, source_frame(2))->has_value()); // ids start anew
}

TEST_F(FrameAssemblerTest, LimitsAreCheckedBeforeAllocating) {
    const ViewGrid grid{.rows = 2, .cols = 2, .geometry = {}, .anchor = Anchor::kLattice};
    const auto views = view_frame(grid);
    assembler_.begin_epoch(3, {.max_width_px = 29});
    EXPECT_FALSE(assembler_.add(views[0]));
    assembler_.begin_epoch(3, {.max_height_px = 129});
    EXPECT_FALSE(assembler_.add(views[0]));
    assembler_.begin_epoch(3, {.max_frame_bytes = 4 * 3 * 30 * 130 - 1});
    EXPECT_FALSE(assembler_.add(views[0]));
    assembler_.begin_epoch(3, {.max_frame_bytes = 4 * 3 * 30 * 130});
    EXPECT_TRUE(assembler_.add(views[0]));
    assembler_.begin_epoch(3, {.max_chunk_bytes = 10});
    EXPECT_TRUE(assembler_.add(views[0]));
    EXPECT_FALSE(assembler_.add(views[1]));
}

TEST_F(FrameAssemblerTest, EmptyChunkIsRefused) {
    EXPECT_FALSE(assembler_.add({}));
    v1::FrameChunk chunk;
    chunk.set_epoch(3);
    chunk.set_frame_id(1);
    EXPECT_FALSE(assembler_.add(chunk));
    chunk.mutable_trailer();
    chunk.set_frame_id(2);
    EXPECT_FALSE(assembler_.add(chunk));
}

} // namespace
} // namespace fieldcast::wire
