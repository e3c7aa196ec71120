// SPDX-License-Identifier: Apache-2.0
// Planes in another format than that of source frames: normals of 8 bits a component.
#include "core/lightfield/normal_precision.h"

#include "tests/wire/test_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

class PlaneFormatsTest : public ::testing::Test {
protected:
    PlaneFormatsTest() { assembler_.begin_epoch(3, {}); }

    EncodedSource encode(const SourceFrame& frame, const KeyFrame& key = {}) {
        const std::vector<PlaneChoice> both{fine_, coarse_};
        return encode_source(frame, both, key, pool_);
    }

    std::vector<v1::FrameChunk> chunks_of(const EncodedSource& source, PlaneChoice choice) {
        return all_chunks(source_chunks(source, std::span(&choice, 1), {.epoch = 3, .has_key_frame = true}));
    }

    /// The only plane of a frame that arrives.
    Plane received(const std::vector<v1::FrameChunk>& chunks) {
        const auto added = add_all(assembler_, chunks);
        EXPECT_TRUE(added) << added.error().message;
        return added && *added ? std::get<SourceFrame>((*added)->content).planes.front() : Plane{};
    }

    const PlaneChoice fine_{PlaneSemantic::kNormal, {}};
    const PlaneChoice coarse_{PlaneSemantic::kNormal, {}, PlaneFormat::kOct2x8};
    WorkerPool pool_{2};
    FrameAssembler assembler_{&pool_};
};

TEST_F(PlaneFormatsTest, EachClientGetsTheFormatItChose) {
    const SourceFrame frame = test_source(5);
    const Plane& normals = *frame.find(PlaneSemantic::kNormal);
    const EncodedSource source = encode(frame);
    ASSERT_EQ(source.planes.size(), 2U);
    EXPECT_EQ(received(chunks_of(source, fine_)), normals);
    assembler_.begin_epoch(3, {});
    EXPECT_EQ(received(chunks_of(source, coarse_)), coarse_normals(normals));
}

TEST_F(PlaneFormatsTest, StripsReferToTheKeyFrameInTheSameFormat) {
    const SourceFrame key = test_source(5);
    EXPECT_FALSE(received(chunks_of(encode(key, {.frame_id = 5}), coarse_)).bytes.empty());
    SourceFrame next = key; // nothing moves
    next.header.frame_id = 6;
    const EncodedSource source = encode(next, {.frame_id = 5, .source = &key, .is_optional = false});
    EXPECT_FALSE(source.find(coarse_)->stands_alone());
    EXPECT_EQ(source.find(coarse_)->encoded_bytes(), source.find(coarse_)->strips.size() * codec::kStripHeaderBytes)
        << "repetitions";
    EXPECT_EQ(received(chunks_of(source, coarse_)), coarse_normals(*key.find(PlaneSemantic::kNormal)));
}

TEST_F(PlaneFormatsTest, NoOtherPlaneComesInThatFormat) {
    auto chunks = chunks_of(encode(test_source(5)), coarse_);
    chunks[0].mutable_header()->mutable_planes()->mutable_planes(0)->set_semantic(v1::PLANE_SEMANTIC_MATERIAL);
    const auto added = add_all(assembler_, chunks);
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message, HasSubstr("is not sent in format 30"));
}

} // namespace
} // namespace fieldcast::wire
