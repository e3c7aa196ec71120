// SPDX-License-Identifier: Apache-2.0
#include "core/wire/chunks.h"

#include "core/codec/crc32c.h"
#include "tests/wire/test_frames.h"

#include <gtest/gtest.h>
#include <set>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;

TEST(Chunks, AreSerialisedServerMessages) {
    WorkerPool pool(1);
    const auto choices = all_choices();
    const EncodedSource source = encode_source(test_source(5), choices, {}, pool);
    const WireFrame frame = source_chunks(source, choices, {.epoch = 2, .chunk_bytes = kMinChunkBytes});
    for (const WireChunk& chunk : frame.chunks) {
        v1::ServerMessage message;
        ASSERT_TRUE(message.ParseFromString(joined(chunk)));
        EXPECT_EQ(message.SerializeAsString(), joined(chunk)); // what protobuf itself would have written
        EXPECT_EQ(message.frame_chunk().payload().size(), chunk.payload.size());
        EXPECT_EQ(chunk.size(), joined(chunk).size());
    }
}

TEST(Chunks, PayloadIsSharedByAllClients) {
    WorkerPool pool(2);
    const ViewGrid largest{.rows = 4, .cols = 4, .geometry = {}, .anchor = Anchor::kLattice};
    const ViewFormat format{.geometry = largest.geometry, .fovy_rad = 0.8F, .width_px = 20, .height_px = 125};
    const EncodedViews views = encode_views(test_views(largest, 20, 125), format, {}, pool);
    std::set<const std::byte*> encoded;
    for (const auto& [position, view] : views.views) {
        for (const EncodedStrip& strip : view.image.strips) {
            encoded.insert(strip.best.bytes->data());
        }
    }
    for (const std::uint32_t side : {1U, 2U, 3U, 4U}) {
        const ViewGrid grid{.rows = side, .cols = side, .geometry = largest.geometry, .anchor = Anchor::kLattice};
        const WireFrame frame = view_chunks(views, grid, {.epoch = side});
        EXPECT_EQ(frame.chunks.size(), 1 + 2 * grid.view_count());
        for (std::size_t i = 1; i < frame.chunks.size(); ++i) {
            EXPECT_TRUE(encoded.contains(frame.chunks[i].payload.data()));
        }
    }
}

TEST(Chunks, SplitStripsAtTheChunkSize) {
    WorkerPool pool(1);
    SourceFrame frame{test_header(1, 300, 120), {}};
    const Camera widened = with_guard_band(frame.header.source, frame.header.guard_band);
    frame.planes = {random_plane(PlaneFormat::kU32, widened.width_px, widened.height_px)};
    const std::vector<PlaneChoice> choices{{PlaneSemantic::kId, {Codec::kRaw}}};
    const WireFrame wire =
        source_chunks(encode_source(frame, choices, {}, pool), choices, {.chunk_bytes = kMinChunkBytes});
    std::uint64_t total = 0;
    std::uint32_t crc = 0;
    for (const WireChunk& chunk : wire.chunks) {
        EXPECT_LE(chunk.payload.size(), kMinChunkBytes);
        EXPECT_LT(chunk.head.size(), 512U);
        total += chunk.payload.size();
        crc = codec::crc32c(chunk.payload, crc);
    }
    EXPECT_EQ(total, wire.payload_bytes);
    EXPECT_EQ(crc, wire.crc32c);
    EXPECT_GT(wire.chunks.size(), 9U);
}

TEST(Chunks, ClientsChooseCodecsFromOneEncoding) {
    WorkerPool pool(1);
    const std::vector<PlaneChoice> both{{PlaneSemantic::kDepth, {Codec::kRaw}},
                                        {PlaneSemantic::kDepth, {Codec::kZstdFiltered}},
                                        {PlaneSemantic::kDepth, {Codec::kRaw}}};
    const EncodedSource source = encode_source(test_source(1), both, {}, pool);
    EXPECT_EQ(source.planes.size(), 2U);
    const WireFrame raw = source_chunks(source, std::span(both).first(1), {});
    const WireFrame zstd = source_chunks(source, std::span(both).subspan(1, 1), {});
    EXPECT_LT(zstd.payload_bytes, raw.payload_bytes);
    EXPECT_EQ(source.find({PlaneSemantic::kNormal, {Codec::kRaw}}), nullptr);
}

TEST(Chunks, UnencodedSelectionsAreOurBug) {
    WorkerPool pool(1);
    const std::vector<PlaneChoice> choices{{PlaneSemantic::kDepth, {Codec::kRaw}}};
    const EncodedSource source = encode_source(test_source(1), choices, {}, pool);
    const std::vector<PlaneChoice> other{{PlaneSemantic::kId, {Codec::kRaw}}};
    EXPECT_THROW(source_chunks(source, other, {}), std::logic_error);
    EXPECT_THROW(encode_source(SourceFrame{}, choices, {}, pool), std::logic_error);
}

} // namespace
} // namespace fieldcast::wire
