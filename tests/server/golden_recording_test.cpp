// SPDX-License-Identifier: Apache-2.0
// Recordings of every released version can be read for ever. File: make_golden_recording.cpp.
#include "core/codec/plane_codec.h"
#include "server/recording/recording.h"

#include <gtest/gtest.h>

namespace fieldcast::recording {
namespace {

constexpr const char* kFile = "tests/data/recordings/v1.fcrec";

/// What was recorded: byte i of every plane of frame `id` is 7 i + 13 id, 7 bits of it.
Plane recorded_plane(const wire::EncodedPlane& encoded, std::uint64_t id) {
    Plane plane = *codec::allocate_plane(encoded.semantic, encoded.format, encoded.width_px, encoded.height_px);
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        plane.bytes[i] = static_cast<std::byte>((7 * i + 13 * id) & 0x7FU);
    }
    return plane;
}

/// Both forms of every strip give what was recorded; the best one repeats the key frame, whose planes are the same.
void expect_recorded(const wire::EncodedPlane& encoded, std::uint64_t id) {
    const Plane expected = recorded_plane(encoded, id);
    Plane best = *codec::allocate_plane(encoded.semantic, encoded.format, encoded.width_px, encoded.height_px);
    Plane alone = best;
    for (const wire::EncodedStrip& strip : encoded.strips) {
        const Codec codec = encoded.encoding.codec;
        const auto decoded =
            codec::decode_strip(*strip.best.bytes, strip.band, {.codec = codec, .reference = &expected}, best);
        ASSERT_TRUE(decoded.has_value()) << decoded.error().message;
        const auto decoded_alone = codec::decode_strip(*strip.alone.bytes, strip.band, {.codec = codec}, alone);
        ASSERT_TRUE(decoded_alone.has_value()) << decoded_alone.error().message;
    }
    if (!is_lossy(encoded.encoding.codec)) {
        EXPECT_TRUE(best == expected) << "frame " << id << ", plane " << static_cast<int>(encoded.semantic);
        EXPECT_TRUE(alone == expected) << "frame " << id << ", plane " << static_cast<int>(encoded.semantic);
    }
}

TEST(GoldenRecording, Version1TellsItsChannel) {
    const Recording recording(kFile);
    const feed::ChannelInfo& info = recording.info();
    EXPECT_EQ(recording.ignored(), std::nullopt);
    EXPECT_EQ(info.name, "golden");
    EXPECT_EQ(info.scene_hash[0], 0xAB);
    EXPECT_EQ(info.scene_hash[31], 0xAB);
    EXPECT_EQ(info.source_width_px, 64U);
    EXPECT_EQ(info.source_height_px, 36U);
    EXPECT_EQ(info.source_count, 1U);
    EXPECT_FLOAT_EQ(info.fovy_rad, 0.785398F);
    EXPECT_FLOAT_EQ(info.largest_grid.geometry.spacing_m.x, 0.02F);
    EXPECT_FLOAT_EQ(info.frames_per_second, 100.0F);
    EXPECT_EQ(info.guard_band.left_px, 2U);
    EXPECT_EQ(info.guard_band.bottom_px, 1U);
    EXPECT_EQ(info.camera, "LightField");
    ASSERT_EQ(info.bundle->size(), 100U);
    EXPECT_EQ(info.bundle->back(), std::byte{3 * 99 % 256});
}

TEST(GoldenRecording, Version1TellsItsForms) {
    const Recording recording(kFile);
    const auto& forms = recording.info().recorded;
    ASSERT_EQ(forms.size(), 3U);
    const auto& lossless = std::get<feed::ViewSelection>(forms[0]);
    EXPECT_EQ(lossless.grid.rows, 2U);
    EXPECT_EQ(lossless.format.width_px, 32U);
    EXPECT_EQ(lossless.format.encoding.codec, Codec::kZstdFiltered);
    const auto& lossy = std::get<feed::ViewSelection>(forms[1]);
    EXPECT_EQ(lossy.grid.cols, 2U);
    EXPECT_EQ(lossy.format.height_px, 9U);
    EXPECT_EQ(lossy.format.encoding, (codec::Encoding{Codec::kJpeg, 90}));
    const auto& planes = std::get<feed::PlaneSelection>(forms[2]);
    ASSERT_EQ(planes.choices.size(), 6U);
    EXPECT_EQ(planes.choices[0].semantic, PlaneSemantic::kDiffuse);
    EXPECT_EQ(planes.choices[5].semantic, PlaneSemantic::kMaterial);
}

TEST(GoldenRecording, Version1GivesEveryPixel) {
    Recording recording(kFile);
    ASSERT_EQ(recording.frames().size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
        const auto frame = recording.read(i);
        ASSERT_TRUE(frame.has_value()) << frame.error().message;
        const std::uint64_t id = i + 1;
        EXPECT_EQ(recording.frames()[i].mark.at_ns, static_cast<std::int64_t>(i) * 20'000'000);
        EXPECT_EQ(frame->header.frame_id, id);
        EXPECT_EQ(frame->key_frame_id, id == 6 ? 6U : 1U);
        EXPECT_EQ(frame->header.scene_time_ns, static_cast<std::int64_t>(id) * 10'000'000);
        EXPECT_EQ(frame->header.seed, id);
        EXPECT_EQ(frame->header.source.width_px, 64U);
        ASSERT_EQ(frame->source->planes.size(), 6U);
        for (const wire::EncodedPlane& plane : frame->source->planes) {
            EXPECT_EQ(plane.width_px, 69U) << "with guard band";
            EXPECT_EQ(plane.height_px, 38U);
            expect_recorded(plane, id);
        }
        ASSERT_EQ(frame->views.size(), 2U);
        EXPECT_EQ(frame->views[0].views.size(), 4U);
        EXPECT_EQ(frame->views[1].views.size(), 2U);
        for (const wire::EncodedViews& views : frame->views) {
            for (const auto& [position, view] : views.views) {
                EXPECT_EQ(view.discards.out_of_frustum, 1U);
                expect_recorded(view.image, id);
            }
        }
    }
}

} // namespace
} // namespace fieldcast::recording
