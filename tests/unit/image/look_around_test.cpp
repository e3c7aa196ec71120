// SPDX-License-Identifier: Apache-2.0
#include "core/image/look_around.h"

#include "core/image/animated_png.h"
#include "core/image/image_file.h"
#include "tests/unit/image/test_image.h"

#include <gmock/gmock.h>
#include <zlib.h>

namespace fieldcast::image {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

struct Chunk {
    std::string type;
    std::vector<std::byte> body;
};

std::uint32_t big32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
    }
    return value;
}

/// Chunks of a PNG file, their CRCs checked.
std::vector<Chunk> chunks_of(std::span<const std::byte> png) {
    std::vector<Chunk> chunks;
    std::size_t at = 8;
    while (at + 12 <= png.size()) {
        const std::size_t size = big32(png, at);
        if (at + 12 + size > png.size()) {
            break;
        }
        const auto* covered = reinterpret_cast<const Bytef*>(png.data()) + at + 4;
        EXPECT_EQ(big32(png, at + 8 + size), crc32_z(0, covered, size + 4));
        const auto body = png.subspan(at + 8, size);
        chunks.push_back({std::string(reinterpret_cast<const char*>(covered), 4), {body.begin(), body.end()}});
        at += 12 + size;
    }
    EXPECT_EQ(at, png.size());
    return chunks;
}

void append_chunk(std::vector<std::byte>& png, std::string body) {
    const auto size = static_cast<std::uint32_t>(body.size() - 4);
    const auto crc = static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(body.data()), body.size()));
    const auto append_big32 = [](std::string& to, std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) {
            to.push_back(static_cast<char>(value >> shift & 0xFFU));
        }
    };
    std::string chunk;
    append_big32(chunk, size);
    chunk += body;
    append_big32(chunk, crc);
    const auto bytes = std::as_bytes(std::span(chunk));
    png.insert(png.end(), bytes.begin(), bytes.end());
}

std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Turns each frame of an animation into a still PNG and decodes that.
std::vector<Rgba8> frames_of(std::span<const std::byte> animation) {
    const std::vector<Chunk> chunks = chunks_of(animation);
    std::vector<Rgba8> frames;
    for (const Chunk& chunk : chunks) {
        if (chunk.type != "IDAT" && chunk.type != "fdAT") {
            continue;
        }
        const std::size_t skipped = chunk.type == "fdAT" ? 4 : 0;
        std::vector<std::byte> still(animation.begin(), animation.begin() + 8);
        append_chunk(still, "IHDR" + text_of(chunks.front().body));
        append_chunk(still, "IDAT" + text_of(std::span(chunk.body).subspan(skipped)));
        append_chunk(still, "IEND");
        frames.push_back(decode_rgba8(still, "frame", {}));
    }
    return frames;
}

TEST(AnimatedPng, FramesDecodeToTheImages) {
    const Plane red = test::flat_plane(30, 20, 255, 0, 0);
    Plane green = test::flat_plane(30, 20, 0, 255, 0);
    green.bytes[0] = std::byte{7};
    const Plane* const order[]{&red, &green, &red, &red};
    const std::vector<Rgba8> frames = frames_of(encode_animated_png(order, 50ms));
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_THAT(std::vector(frames[0].pixels.begin(), frames[0].pixels.begin() + 4), ElementsAre(255, 0, 0, 255));
    EXPECT_THAT(std::vector(frames[1].pixels.begin(), frames[1].pixels.begin() + 8),
                ElementsAre(7, 255, 0, 255, 0, 255, 0, 255));
    EXPECT_EQ(frames[2].pixels, frames[0].pixels);
    EXPECT_EQ(frames[3].pixels, frames[0].pixels);
}

TEST(AnimatedPng, ControlChunksFollowTheStandard) {
    const Plane a = test::flat_plane(5, 4, 1, 2, 3);
    const Plane b = test::flat_plane(5, 4, 4, 5, 6);
    const Plane* const order[]{&a, &b, &a};
    const std::vector<Chunk> chunks = chunks_of(encode_animated_png(order, 40ms));
    std::vector<std::string> types;
    std::vector<std::uint32_t> sequence;
    for (const Chunk& chunk : chunks) {
        types.push_back(chunk.type);
        if (chunk.type == "fcTL" || chunk.type == "fdAT") {
            sequence.push_back(big32(chunk.body, 0));
        }
        if (chunk.type == "fcTL") {
            ASSERT_EQ(chunk.body.size(), 26U);
            EXPECT_EQ(big32(chunk.body, 4), 5U);
            EXPECT_EQ(big32(chunk.body, 8), 4U);
            EXPECT_EQ(big32(chunk.body, 20), 40U << 16 | 1000U) << "40/1000 s";
        }
        if (chunk.type == "acTL") {
            EXPECT_EQ(big32(chunk.body, 0), 3U);
            EXPECT_EQ(big32(chunk.body, 4), 0U) << "for ever";
        }
    }
    EXPECT_THAT(sequence, ElementsAre(0, 1, 2, 3, 4));
    ASSERT_GE(types.size(), 3U);
    EXPECT_EQ(types[0], "IHDR");
    EXPECT_EQ(types[1], "acTL");
    EXPECT_EQ(types.back(), "IEND");
}

TEST(AnimatedPng, IsAStillImageToOthers) {
    const Plane a = test::flat_plane(5, 4, 1, 2, 3);
    const Plane b = test::flat_plane(5, 4, 4, 5, 6);
    const Plane* const order[]{&a, &b};
    const Rgba8 still = decode_rgba8(encode_animated_png(order, 40ms), "animation", {});
    EXPECT_EQ(still.pixels[0], 1);
    EXPECT_EQ(still.width_px, 5U);
}

TEST(AnimatedPng, RefusesWhatHasNoMeaning) {
    const Plane a = test::flat_plane(5, 4, 1, 2, 3);
    const Plane small = test::flat_plane(4, 4, 1, 2, 3);
    const Plane* const mixed[]{&a, &small};
    EXPECT_THROW(encode_animated_png(mixed, 40ms), std::logic_error);
    EXPECT_THROW(encode_animated_png({}, 40ms), std::logic_error);
    EXPECT_THROW(encode_animated_png(std::span(mixed).first(1), 0ms), std::logic_error);
}

ViewGrid grid_of(std::uint32_t rows, std::uint32_t cols) {
    ViewGrid grid;
    grid.rows = rows;
    grid.cols = cols;
    return grid;
}

TEST(SweepOrder, SerpentineVisitsAllViewsAndReturns) {
    EXPECT_THAT(sweep_order(grid_of(2, 3), SweepPath::kSerpentine), ElementsAre(0, 1, 2, 5, 4, 3, 4, 5, 2, 1));
    EXPECT_EQ(sweep_order(grid_of(6, 6), SweepPath::kSerpentine).size(), 70U);
}

TEST(SweepOrder, CircleFollowsTheBorder) {
    EXPECT_THAT(sweep_order(grid_of(3, 3), SweepPath::kCircle), ElementsAre(0, 1, 2, 5, 8, 7, 6, 3));
    EXPECT_THAT(sweep_order(grid_of(1, 4), SweepPath::kCircle), ElementsAre(0, 1, 2, 3, 2, 1));
    EXPECT_THAT(sweep_order(grid_of(1, 1), SweepPath::kCircle), ElementsAre(0));
}

TEST(SweepOrder, OnlyStepsToNeighbours) {
    for (const SweepPath path : {SweepPath::kSerpentine, SweepPath::kCircle}) {
        for (const ViewGrid& grid : {grid_of(6, 6), grid_of(2, 5), grid_of(5, 1), grid_of(1, 72), grid_of(2, 2)}) {
            const std::vector<std::uint32_t> order = sweep_order(grid, path);
            for (std::size_t i = 0; i < order.size(); ++i) {
                const LatticePosition a = lattice_position(grid, order[i] / grid.cols, order[i] % grid.cols);
                const std::uint32_t next = order[(i + 1) % order.size()];
                const LatticePosition b = lattice_position(grid, next / grid.cols, next % grid.cols);
                EXPECT_EQ(std::abs(a.row_halves - b.row_halves) + std::abs(a.col_halves - b.col_halves), 2);
            }
        }
    }
}

TEST(LookAround, WritesOneFrameForEachStep) {
    const test::TestFolder folder;
    const ViewGrid grid = grid_of(2, 2);
    std::vector<View> views;
    for (std::uint8_t i = 0; i < 4; ++i) {
        views.push_back({{}, test::flat_plane(8, 8, i, 0, 0), {}});
    }
    write_look_around(folder.path() / "look.png", grid, views, SweepPath::kCircle, 60ms);
    const std::vector<Rgba8> frames = frames_of(test::file_bytes(folder.path() / "look.png"));
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_EQ(frames[2].pixels[0], 3) << "the view at the bottom right comes third";
}

} // namespace
} // namespace fieldcast::image
