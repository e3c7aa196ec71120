// SPDX-License-Identifier: Apache-2.0
// Strips that refer to key frames: who can decode what, and what happens when the key frame is missing.
#include "tests/wire/test_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

class KeyFramesTest : public ::testing::Test {
protected:
    KeyFramesTest() { assembler_.begin_epoch(3, {}); }

    /// A frame like the key frame but for its id and a few pixels of the specular plane.
    SourceFrame frame_near_key(std::uint64_t frame_id) const {
        SourceFrame frame = key_source_;
        frame.header.frame_id = frame_id;
        for (std::size_t i = 0; i < frame.planes[0].bytes.size(); i += 64) {
            frame.planes[0].bytes[i] ^= static_cast<std::byte>(frame_id);
        }
        return frame;
    }

    std::vector<v1::FrameChunk> chunks_of(const EncodedSource& source, bool has_key_frame) {
        return all_chunks(source_chunks(source, all_choices(), {.epoch = 3, .has_key_frame = has_key_frame}));
    }

    EncodedSource encode_key() { return encode_source(key_source_, all_choices(), {.frame_id = kKeyId}, pool_); }

    EncodedSource encode_near(std::uint64_t frame_id, bool is_optional = true) {
        const KeyFrame key{.frame_id = kKeyId, .source = &key_source_, .is_optional = is_optional};
        return encode_source(frame_near_key(frame_id), all_choices(), key, pool_);
    }

    void expect_arrives(const std::vector<v1::FrameChunk>& chunks, const SourceFrame& sent) {
        const auto added = add_all(assembler_, chunks);
        ASSERT_TRUE(added) << added.error().message;
        ASSERT_TRUE(*added);
        EXPECT_TRUE(std::get<SourceFrame>((*added)->content).planes == sent.planes);
    }

    void expect_refused(const std::vector<v1::FrameChunk>& chunks, const std::string& message) {
        const auto added = add_all(assembler_, chunks);
        ASSERT_FALSE(added) << message;
        EXPECT_THAT(added.error().message, HasSubstr(message));
    }

    static constexpr std::uint64_t kKeyId = 5;
    const SourceFrame key_source_ = test_source(kKeyId);
    WorkerPool pool_{2};
    FrameAssembler assembler_{&pool_};
};

TEST_F(KeyFramesTest, FramesReferToTheKeyFrameWhateverWasDroppedBetween) {
    const EncodedSource key = encode_key();
    EXPECT_TRUE(std::ranges::all_of(key.planes, &EncodedPlane::stands_alone));
    expect_arrives(chunks_of(key, true), key_source_);
    for (const std::uint64_t frame_id : {6U, 9U, 40U}) {
        const EncodedSource near = encode_near(frame_id);
        std::uint64_t key_bytes = 0;
        std::uint64_t near_bytes = 0;
        for (std::size_t i = 0; i < near.planes.size(); ++i) {
            key_bytes += key.planes[i].encoded_bytes();
            near_bytes += near.planes[i].encoded_bytes();
        }
        EXPECT_LT(near_bytes * 4, key_bytes); // five of six planes are repeated
        expect_arrives(chunks_of(near, true), frame_near_key(frame_id));
    }
}

TEST_F(KeyFramesTest, WhoJoinsLateGetsStripsThatStandAlone) {
    expect_arrives(chunks_of(encode_near(6), false), frame_near_key(6));
    expect_refused(chunks_of(encode_near(7), true), "5 is not the last key frame: there is none");
    EXPECT_FALSE(std::ranges::all_of(encode_near(8, false).planes, &EncodedPlane::stands_alone));
    EXPECT_THROW(chunks_of(encode_near(8, false), false), std::logic_error);
}

TEST_F(KeyFramesTest, OnlyTheLastKeyFrameIsKept) {
    expect_arrives(chunks_of(encode_key(), true), key_source_);
    SourceFrame second = test_source(8);
    expect_arrives(chunks_of(encode_source(second, all_choices(), {.frame_id = 8}, pool_), true), second);
    expect_refused(chunks_of(encode_near(9), true), "5 is not the last key frame, 8 is");
}

TEST_F(KeyFramesTest, FramesThatStandAloneLeaveTheKeyFrame) {
    expect_arrives(chunks_of(encode_key(), true), key_source_);
    expect_arrives(chunks_of(encode_near(6), false), frame_near_key(6));
    expect_arrives(chunks_of(encode_near(7), true), frame_near_key(7));
}

TEST_F(KeyFramesTest, ADamagedKeyFrameIsNotKept) {
    auto chunks = chunks_of(encode_key(), true);
    chunks.back().mutable_trailer()->set_crc32c(chunks.back().trailer().crc32c() ^ 1);
    expect_refused(chunks, "crc32c");
    expect_refused(chunks_of(encode_near(6), true), "there is none");
}

TEST_F(KeyFramesTest, ANewEpochForgetsTheKeyFrame) {
    expect_arrives(chunks_of(encode_key(), true), key_source_);
    assembler_.begin_epoch(3, {});
    expect_refused(chunks_of(encode_near(6), true), "there is none");
}

TEST_F(KeyFramesTest, TheKeyFrameMustHaveTheSamePlanes) {
    const std::vector<PlaneChoice> one{{PlaneSemantic::kId, {Codec::kZstdFiltered}}};
    const EncodedSource key = encode_source(key_source_, one, {.frame_id = kKeyId}, pool_);
    ASSERT_TRUE(add_all(assembler_, all_chunks(source_chunks(key, one, {.epoch = 3}))));
    expect_refused(chunks_of(encode_near(6), true), "other planes");
}

TEST_F(KeyFramesTest, StripsMayNotReferWithoutTheHeaderSayingSo) {
    expect_arrives(chunks_of(encode_key(), true), key_source_);
    auto chunks = chunks_of(encode_near(6), true);
    chunks[0].mutable_header()->clear_key_frame_id();
    expect_refused(chunks, "refers to another frame");
}

TEST_F(KeyFramesTest, ViewsReferByTheirPosition) {
    const ViewGrid grid{.rows = 2, .cols = 2, .geometry = {}, .anchor = Anchor::kLattice};
    const ViewFormat format{.geometry = {}, .fovy_rad = 0.7F, .width_px = 30, .height_px = 130};
    Views views = test_views(grid, 30, 130);
    views.header.frame_id = kKeyId;
    const ChunkOptions options{.epoch = 3};
    ASSERT_TRUE(add_all(
        assembler_, all_chunks(view_chunks(encode_views(views, format, {.frame_id = kKeyId}, pool_), grid, options))));
    Views shuffled = views;
    std::ranges::reverse(shuffled.views); // order does not matter to the encoder
    const KeyFrame key{.frame_id = kKeyId, .views = &shuffled};
    views.header.frame_id = 6;
    const EncodedViews encoded = encode_views(views, format, key, pool_);
    for (const auto& [position, view] : encoded.views) {
        EXPECT_EQ(view.image.encoded_bytes(), 2 * codec::kStripHeaderBytes) << "two strips, both repeated";
    }
    const auto added = add_all(assembler_, all_chunks(view_chunks(encoded, grid, options)));
    ASSERT_TRUE(added) << added.error().message;
    const auto& received = std::get<ReceivedViews>((*added)->content);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(received.views.views[i].image == views.views[i].image);
    }
}

} // namespace
} // namespace fieldcast::wire
