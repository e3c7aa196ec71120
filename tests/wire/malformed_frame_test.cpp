// SPDX-License-Identifier: Apache-2.0
#include "tests/wire/test_frames.h"

#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

std::vector<v1::FrameChunk> source_frame() {
    WorkerPool pool(1);
    const auto choices = all_choices();
    return all_chunks(source_chunks(encode_source(test_source(1), choices, {}, pool), choices, {.chunk_bytes = 100}));
}

std::vector<v1::FrameChunk> view_frame() {
    WorkerPool pool(1);
    const ViewGrid grid{.rows = 1, .cols = 2, .geometry = {}, .anchor = Anchor::kLattice};
    const ViewFormat format{.geometry = {}, .fovy_rad = 0.7F, .width_px = 8, .height_px = 8};
    const EncodedViews views = encode_views(test_views(grid, 8, 8), format, {}, pool);
    return all_chunks(view_chunks(views, grid, {}));
}

struct Damage {
    const char* error;
    std::size_t chunk;
    std::function<void(v1::FrameChunk&)> apply;
};

void expect_refused(const std::vector<v1::FrameChunk>& chunks, const std::vector<Damage>& damages) {
    for (const Damage& damage : damages) {
        FrameAssembler assembler;
        assembler.begin_epoch(1, {});
        auto damaged = chunks;
        damage.apply(damaged[std::min(damage.chunk, chunks.size() - 1)]);
        const auto added = add_all(assembler, damaged);
        ASSERT_FALSE(added) << damage.error;
        EXPECT_THAT(added.error().message, HasSubstr(damage.error));
    }
}

v1::PlaneHeader& plane(v1::FrameChunk& chunk, int index) {
    return *chunk.mutable_header()->mutable_planes()->mutable_planes(index);
}

constexpr std::uint32_t kHuge = 0xFFFFFFFF;
constexpr std::size_t kLast = 0xFFFF;

TEST(MalformedFrame, HostilePlaneHeaders) {
    expect_refused(
        source_frame(),
        {
            {"header.planes: 1 to 16", 0, [](auto& c) { c.mutable_header()->clear_content(); }},
            {"header.planes: 1 to 16", 0, [](auto& c) { c.mutable_header()->mutable_planes()->clear_planes(); }},
            {"twice", 0, [](auto& c) { plane(c, 1) = plane(c, 0); }},
            {"unknown semantic", 0, [](auto& c) { plane(c, 0).set_semantic(static_cast<v1::PlaneSemantic>(99)); }},
            {"unknown semantic", 0, [](auto& c) { plane(c, 0).set_codec(static_cast<v1::Codec>(99)); }},
            {"is not for format", 0, [](auto& c) { plane(c, 1).set_codec(v1::CODEC_JPEG); }},
            {"is not sent in format", 0, [](auto& c) { plane(c, 0).set_format(v1::PLANE_FORMAT_RG8); }},
            {"size differs", 0, [](auto& c) { plane(c, 0).set_width_px(kHuge); }},
            {"size differs", 0, [](auto& c) { plane(c, 5).set_height_px(1); }},
            {"sides", 0, [](auto& c) { c.mutable_header()->mutable_source()->set_width_px(kHuge); }},
            {"at most 4096", 0, [](auto& c) { c.mutable_header()->mutable_source()->set_width_px(16000); }},
            {"with payload", 0, [](auto& c) { c.set_payload("x"); }},
            {"1 to 16 planes", 0,
             [](auto& c) {
                 while (c.header().planes().planes_size() <= 16) {
                     c.mutable_header()->mutable_planes()->add_planes();
                 }
             }},
        });
}

TEST(MalformedFrame, HostileStrips) {
    expect_refused(
        source_frame(),
        {
            {"strip.part", 1, [](auto& c) { c.mutable_strip()->set_part(std::uint32_t{kUsualFormats.size()}); }},
            {"strip.part", 1, [](auto& c) { c.mutable_strip()->set_part(kHuge); }},
            {"is next", 1, [](auto& c) { c.mutable_strip()->set_first_row(1); }},
            {"is next", 1, [](auto& c) { c.mutable_strip()->set_first_row(kHuge); }},
            {"is next", 1, [](auto& c) { c.mutable_strip()->set_row_count(0); }},
            {"is next", 1, [](auto& c) { c.mutable_strip()->set_row_count(kHuge); }},
            {"at most", 1, [](auto& c) { c.mutable_strip()->set_strip_bytes(kHuge); }},
            {"at most", 1, [](auto& c) { c.mutable_strip()->set_strip_bytes(0); }},
            {"from offset", 1, [](auto& c) { c.mutable_strip()->set_slice_offset(1); }},
            {"are missing", 1, [](auto& c) { c.clear_payload(); }},
            {"does not continue", 2, [](auto& c) { c.mutable_strip()->set_slice_offset(0); }},
            {"does not continue", 2, [](auto& c) { c.mutable_strip()->set_part(1); }},
            {"does not continue", 2, [](auto& c) { c.mutable_strip()->set_strip_bytes(100); }},
            {"are missing", 2, [](auto& c) { c.set_payload(std::string(1 << 20, 'x')); }},
            {"payload of", 2, [](auto& c) { c.set_payload(std::string((2 << 20) + 1, 'x')); }},
            {"neither header", 2, [](auto& c) { c.clear_content(); }},
            {"trailer with payload", kLast, [](auto& c) { c.set_payload("x"); }},
            {"ends at row", 1,
             [](auto& c) {
                 c.mutable_trailer();
                 c.clear_payload();
             }},
        });
}

TEST(MalformedFrame, HostileViews) {
    const auto set = [](v1::FrameChunk& c) { return c.mutable_header()->mutable_views()->mutable_view_set(); };
    const auto discards = [](v1::FrameChunk& c) { return c.mutable_trailer()->mutable_discards(0); };
    expect_refused(view_frame(),
                   {
                       {"rows and columns", 0, [&](auto& c) { set(c)->mutable_grid()->clear_rows(); }},
                       {"at most 72", 0, [&](auto& c) { set(c)->mutable_grid()->set_rows(kHuge); }},
                       {"sides", 0, [&](auto& c) { set(c)->set_width_px(kHuge); }},
                       {"at most 4096x4096", 0, [&](auto& c) { set(c)->set_height_px(5000); }},
                       {"unknown codec", 0, [](auto& c) { c.mutable_header()->mutable_views()->clear_codec(); }},
                       {"entries for 2", kLast, [](auto& c) { c.mutable_trailer()->add_discards(); }},
                       {"entries for 2", kLast, [](auto& c) { c.mutable_trailer()->clear_discards(); }},
                       {"more pixels", kLast, [&](auto& c) { discards(c)->set_id(kHuge); }},
                   });
}

TEST(MalformedFrame, FramesLargerThanTheLimitAreNotAllocated) {
    auto chunks = view_frame();
    v1::ViewSet& set = *chunks[0].mutable_header()->mutable_views()->mutable_view_set();
    set.mutable_grid()->set_cols(72);
    set.set_width_px(4096);
    set.set_height_px(4096); // 3.4 GiB
    FrameAssembler assembler;
    assembler.begin_epoch(1, {});
    const auto added = assembler.add(chunks[0]);
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message, HasSubstr("at most 536870912"));
}

TEST(MalformedFrame, TruncatedMessagesAreParsedOrRefused) {
    for (const auto& chunks : {source_frame(), view_frame()}) {
        for (const std::size_t which : {std::size_t{0}, std::size_t{1}, chunks.size() - 1}) {
            const std::string bytes = chunks[which].SerializeAsString();
            for (std::size_t size = 0; size < bytes.size(); ++size) {
                v1::FrameChunk cut;
                auto damaged = chunks;
                if (cut.ParseFromString(bytes.substr(0, size))) {
                    damaged[which] = cut;
                    FrameAssembler assembler;
                    assembler.begin_epoch(1, {});
                    static_cast<void>(add_all(assembler, damaged));
                }
            }
        }
    }
}

TEST(MalformedFrame, RandomDamageNeverCrashes) {
    std::mt19937 random(3);
    WorkerPool pool(2);
    int completed = 0;
    for (const auto& chunks : {source_frame(), view_frame()}) {
        for (int round = 0; round < 400; ++round) {
            auto damaged = chunks;
            const std::size_t which = random() % 2 == 0 ? 0 : random() % chunks.size();
            std::string bytes = chunks[which].SerializeAsString();
            for (auto flips = 1 + random() % 3; flips > 0; --flips) {
                bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
            }
            if (!damaged[which].ParseFromString(bytes)) {
                continue;
            }
            FrameAssembler assembler(&pool);
            assembler.begin_epoch(1, {.max_frame_bytes = 8U << 20});
            const auto added = add_all(assembler, damaged);
            completed += added && *added ? 1 : 0;
        }
    }
    EXPECT_GT(completed, 0); // a flip in the header may be legal, such as another seed
}

} // namespace
} // namespace fieldcast::wire
