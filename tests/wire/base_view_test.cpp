// SPDX-License-Identifier: Apache-2.0
// Views that are predicted from one view of the same frame.
#include "core/wire/base_view.h"

#include "tests/wire/test_frames.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

ViewGrid grid_of(std::uint32_t rows, std::uint32_t cols, Anchor anchor = Anchor::kLattice) {
    return {.rows = rows, .cols = cols, .geometry = {}, .anchor = anchor};
}

/// Soft views of 48 × 130 pixels (two strips) that differ by a shift.
Views soft_views(const ViewGrid& grid, std::uint64_t frame_id) {
    Views views = test_views(grid, 48, 130);
    views.header.frame_id = frame_id;
    for (View& view : views.views) {
        const int shift = 2 * view.position.col_halves + view.position.row_halves;
        for (std::size_t i = 0; i < view.image.bytes.size(); ++i) {
            const double x = static_cast<double>(i / 3 % 48) + shift;
            view.image.bytes[i] =
                static_cast<std::byte>(128.0 + 90.0 * std::sin(0.3 * x + 0.05 * static_cast<double>(i / 144)));
        }
    }
    return views;
}

ViewFormat h264_format() {
    return {.geometry = {},
            .fovy_rad = 0.7F,
            .width_px = 48,
            .height_px = 130,
            .encoding = {Codec::kH264, 75}};
}

/// Codings of a part's strips, from the top.
std::vector<int> codings_of(const EncodedViews& views, LatticePosition position) {
    std::vector<int> codings;
    for (const EncodedStrip& strip : views.views.at(position).image.strips) {
        const auto header = codec::read_header(*strip.best.bytes);
        codings.push_back(static_cast<int>(header->coding) + (header->is_predicted ? 100 : 0));
    }
    return codings;
}

constexpr int kAlone = static_cast<int>(codec::StripCoding::kH264);
constexpr int kPredicted = 100 + kAlone;
constexpr int kRepeat = static_cast<int>(codec::StripCoding::kRepeat);

int largest_error(const Views& a, const Views& b) {
    int largest = 0;
    for (std::size_t view = 0; view < a.views.size(); ++view) {
        const auto& ours = a.views[view].image.bytes;
        const auto& theirs = b.views[view].image.bytes;
        for (std::size_t i = 0; i < ours.size(); ++i) {
            largest = std::max(largest, std::abs(std::to_integer<int>(ours[i]) - std::to_integer<int>(theirs[i])));
        }
    }
    return largest;
}

TEST(BaseView, EveryGridHasTheBaseOfAllItsViews) {
    for (const Anchor anchor : {Anchor::kLattice, Anchor::kCentre}) {
        for (std::uint32_t rows = 1; rows <= 8; ++rows) {
            for (std::uint32_t cols = 1; cols <= 9; ++cols) {
                const ViewGrid grid = grid_of(rows, cols, anchor);
                const auto positions = lattice_positions(grid);
                const LatticePosition base = positions[base_part(grid)];
                EXPECT_TRUE(std::ranges::all_of(positions, [&](auto p) { return base_position(p) == base; }));
            }
        }
    }
    EXPECT_EQ(base_position({6, -4}), (LatticePosition{0, 0}));
    EXPECT_EQ(base_position({5, -3}), (LatticePosition{-1, -1}));
}

TEST(BaseView, ViewsArePredictedAndDecodeInEveryGrid) {
    WorkerPool pool(2);
    const Views sent = soft_views(grid_of(4, 4), 1);
    const EncodedViews encoded = encode_views(sent, h264_format(), {}, pool);
    EXPECT_THAT(codings_of(encoded, {0, 0}), ::testing::ElementsAre(kAlone, kAlone));
    EXPECT_THAT(codings_of(encoded, {2, 4}), ::testing::ElementsAre(kPredicted, kPredicted));
    for (const ViewGrid& grid : {grid_of(4, 4), grid_of(1, 2), grid_of(3, 1), grid_of(1, 1)}) {
        FrameAssembler assembler(&pool);
        assembler.begin_epoch(1, {});
        const auto added = add_all(assembler, all_chunks(view_chunks(encoded, grid, {.chunk_bytes = 200})));
        ASSERT_TRUE(added && *added) << (added ? "incomplete" : added.error().message);
        const Views& views = std::get<ReceivedViews>((**added).content).views;
        Views expected{sent.header, {}};
        for (const LatticePosition position : lattice_positions(grid)) {
            expected.views.push_back(*std::ranges::find(sent.views, position, &View::position));
        }
        ASSERT_EQ(views.views.size(), expected.views.size());
        EXPECT_LE(largest_error(views, expected),
                  30); // a quantiser of 24 has steps of 10; colours have half the pixels
    }
}

TEST(BaseView, RowsThatTheBaseRepeatsAreNotPredicted) {
    WorkerPool pool(2);
    const ViewGrid grid = grid_of(1, 2);
    const Views key = soft_views(grid, 1);
    Views second = soft_views(grid, 2);
    for (std::size_t i = 0; i < second.views[1].image.bytes.size(); ++i) {
        second.views[1].image.bytes[i] ^= std::byte{8}; // the base stays, the other view changes
    }
    const KeyFrame key_frame{.frame_id = 1, .source = nullptr, .views = &key, .is_optional = true};
    const EncodedViews encoded = encode_views(second, h264_format(), key_frame, pool);
    EXPECT_THAT(codings_of(encoded, {0, 0}), ::testing::ElementsAre(kRepeat, kRepeat));
    EXPECT_THAT(codings_of(encoded, {0, 2}), ::testing::ElementsAre(kAlone, kAlone));
}

TEST(BaseView, PredictedStripsNeedTheBaseBeforeThem) {
    WorkerPool pool(1);
    const ViewGrid grid = grid_of(1, 2);
    const EncodedViews encoded = encode_views(soft_views(grid, 1), h264_format(), {}, pool);
    auto chunks = all_chunks(view_chunks(encoded, grid, {}));
    ASSERT_EQ(chunks.size(), 6U); // header, two strips of two views, trailer
    std::swap(chunks[1], chunks[3]);
    std::swap(chunks[2], chunks[4]);
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        chunks[i].set_index(static_cast<std::uint32_t>(i));
    }
    FrameAssembler assembler;
    assembler.begin_epoch(1, {});
    const auto added = add_all(assembler, chunks);
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message, HasSubstr("has no such strip"));
}

} // namespace
} // namespace fieldcast::wire
