// SPDX-License-Identifier: Apache-2.0
#include "core/codec/plane_codec.h"

#include "tests/wire/test_files.h"
#include "tests/wire/test_planes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::codec {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

constexpr RowBand kBand{3, 15};

struct MalformedFile {
    const char* name;
    const char* error;
    Codec announced = Codec::kZstdFiltered;
    PlaneFormat format = PlaneFormat::kRgb8;
};

TEST(MalformedStrip, FilesGiveTheNamedError) {
    const std::vector<MalformedFile> files{
        {"empty", "the header has 16"},
        {"truncated_header", "the header has 16"},
        {"truncated_body", "bytes follow"},
        {"version", "version 2 is not 1"},
        {"codec", "unknown codec"},
        {"format", "unknown codec or format"},
        {"other_format", "differ from what was announced"},
        {"predictor", "predictor 5"},
        {"word", "channels of layout 2"},
        {"floats_layout", "channels of layout 11"},
        {"flags", "flags"},
        {"raw_flags", "flags"},
        {"reference", "refers to another frame"},
        {"repeat", "refers to another frame"},
        {"repeat_filter", "only ZSTD_FILTERED has a filter"},
        {"width", "differ from what was announced"},
        {"rows", "differ from what was announced"},
        {"raw_filter", "only ZSTD_FILTERED has a filter"},
        {"raw_short", "raw bytes"},
        {"two_frames", "not exactly one zstd frame"},
        {"cut_frame", "not exactly one zstd frame"},
        {"huge_content", "does not declare"},
        {"other_content", "does not declare"},
        {"jpeg_filter", "only ZSTD_FILTERED has a filter"},
        {"jpeg_in_zstd_plane", "jpeg in a plane of another codec"},
        {"jpeg_cut", "damaged", Codec::kJpeg},
        {"light_no_curve", "without its curve", Codec::kJpeg, PlaneFormat::kR11G11B10F},
        {"light_no_picture", "JPEG", Codec::kJpeg, PlaneFormat::kR11G11B10F},
        {"light_negative_knee", "knee or top", Codec::kJpeg, PlaneFormat::kR11G11B10F},
        {"light_infinite_top", "knee or top", Codec::kJpeg, PlaneFormat::kR11G11B10F},
    };
    for (const MalformedFile& file : files) {
        Plane plane = empty_plane(file.format, 33, 20);
        const auto strip = read_bytes("tests/data/wire/v1/malformed/" + std::string(file.name) + ".strip");
        const auto result = decode_strip(strip, kBand, {.codec = file.announced}, plane);
        ASSERT_FALSE(result) << file.name;
        EXPECT_THAT(result.error().message, HasSubstr(file.error)) << file.name;
    }
}

TEST(MalformedStrip, RepetitionsHaveNoBytes) {
    const Plane reference = ramp_plane(PlaneFormat::kRgb8, 33, 20);
    Plane plane = empty_plane(PlaneFormat::kRgb8, 33, 20);
    const auto result = decode_strip(read_bytes("tests/data/wire/v1/malformed/repeat_body.strip"), kBand,
                                     {.reference = &reference}, plane);
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().message, HasSubstr("has no bytes"));
}

TEST(MalformedStrip, EveryTruncationIsRefused) {
    for (const PlaneFormat format : kAllFormats) {
        const Plane plane = ramp_plane(format, 33, 20);
        for (const Codec codec : {Codec::kRaw, Codec::kZstdFiltered}) {
            const auto strip = encode_strip(plane, kBand, {.encoding = {codec}});
            Plane decoded = empty_plane(format, 33, 20);
            for (std::size_t size = 0; size < strip.size(); ++size) {
                const std::vector<std::byte> cut(strip.begin(), strip.begin() + static_cast<std::ptrdiff_t>(size));
                EXPECT_FALSE(decode_strip(cut, kBand, {}, decoded)) << name_of(format) << " cut to " << size;
            }
        }
    }
}

TEST(MalformedStrip, RefusesRowsOutsideThePlane) {
    const Plane plane = ramp_plane(PlaneFormat::kRgb8, 33, 20);
    const auto strip = encode_strip(plane, kBand, {.encoding = {Codec::kRaw}});
    Plane decoded = empty_plane(PlaneFormat::kRgb8, 33, 20);
    for (const RowBand band : {RowBand{20, 1}, RowBand{6, 15}, RowBand{0, 0}, RowBand{0xFFFFFFFF, 2}}) {
        EXPECT_FALSE(decode_strip(strip, band, {}, decoded));
    }
}

// A damaged body may decode to other pixels (only the CRC of the frame can tell), but it never writes elsewhere.
TEST(MalformedStrip, RandomDamageNeverReachesOtherRows) {
    std::mt19937 random(7);
    for (const PlaneFormat format : kAllFormats) {
        const Plane reference = ramp_plane(format, 33, 20, 1);
        const auto strip = encode_strip(ramp_plane(format, 33, 20), kBand, {.reference = &reference});
        const std::size_t row_bytes = 33 * bytes_per_pixel(format);
        Plane decoded = empty_plane(format, 33, 20);
        for (int round = 0; round < 2000; ++round) {
            auto damaged = strip;
            for (auto flips = 1 + random() % 4; flips > 0; --flips) {
                damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << random() % 8);
            }
            static_cast<void>(decode_strip(damaged, kBand, {.reference = &reference}, decoded));
        }
        for (std::size_t i = 0; i < decoded.bytes.size(); ++i) {
            if (i / row_bytes < 3 || i / row_bytes >= 18) {
                ASSERT_EQ(decoded.bytes[i], std::byte{0}) << name_of(format) << " byte " << i;
            }
        }
    }
}

TEST(MalformedStrip, RandomBytesAreRefused) {
    std::mt19937 random(11);
    Plane decoded = empty_plane(PlaneFormat::kF32, 16, 16);
    for (int round = 0; round < 5000; ++round) {
        std::vector<std::byte> bytes(random() % 200);
        for (std::byte& byte : bytes) {
            byte = static_cast<std::byte>(random());
        }
        EXPECT_FALSE(decode_strip(bytes, {0, 16}, {}, decoded));
    }
}

} // namespace
} // namespace fieldcast::codec
