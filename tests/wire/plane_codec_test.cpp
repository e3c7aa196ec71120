// SPDX-License-Identifier: Apache-2.0
#include "core/codec/light_curve.h"
#include "core/codec/plane_codec.h"

#include "tests/wire/test_planes.h"

#include <gtest/gtest.h>
#include <tuple>

namespace fieldcast::codec {
namespace {

using namespace fieldcast::testing;

using Case = std::tuple<PlaneFormat, Codec>;

class EveryCodec : public ::testing::TestWithParam<Case> {
protected:
    PlaneFormat format() const { return std::get<0>(GetParam()); }
    Codec codec() const { return std::get<1>(GetParam()); }

    void expect_round_trip(const Plane& plane, const std::string& what) const {
        Plane decoded = empty_plane(plane.format, plane.width_px, plane.height_px);
        for (const RowBand band : strip_bands(plane.height_px)) {
            const auto strip = encode_strip(plane, band, {.encoding = {codec()}});
            EXPECT_LE(strip.size(), max_strip_bytes(plane.format, plane.width_px, band.row_count)) << what;
            const auto result = decode_strip(strip, band, {}, decoded);
            ASSERT_TRUE(result) << what << ": " << result.error().message;
        }
        EXPECT_TRUE(decoded == plane) << what;
    }
};

TEST_P(EveryCodec, RoundTripsEverySize) {
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{1, 1},   {1, 7},    {2, 1},    {3, 2},
                                                                     {17, 33}, {64, 120}, {63, 121}, {31, 479}};
    for (const auto& [width, height] : sizes) {
        const std::string size = std::to_string(width) + "x" + std::to_string(height);
        expect_round_trip(random_plane(format(), width, height), "random " + size);
        expect_round_trip(ramp_plane(format(), width, height), "ramp " + size);
        expect_round_trip(empty_plane(format(), width, height), "constant " + size);
    }
}

TEST_P(EveryCodec, RoundTripsTheWidestRow) {
    expect_round_trip(ramp_plane(format(), kMaxPlaneSide, 2), "widest");
}

TEST_P(EveryCodec, StripsAreIndependent) {
    const Plane plane = ramp_plane(format(), 40, 300);
    const RowBand band{120, 120};
    Plane decoded = empty_plane(format(), 40, 300);
    ASSERT_TRUE(
        decode_strip(encode_strip(plane, band, {.encoding = {codec()}}), band, {}, decoded)); // the others never arrive
    const std::size_t row_bytes = 40 * bytes_per_pixel(format());
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        const bool is_inside = i / row_bytes >= 120 && i / row_bytes < 240;
        ASSERT_EQ(decoded.bytes[i], is_inside ? plane.bytes[i] : std::byte{0}) << i;
    }
}

TEST_P(EveryCodec, TakesAnyNumberOfRows) {
    const Plane plane = ramp_plane(format(), 9, 50);
    for (const RowBand band : {RowBand{0, 50}, RowBand{3, 1}, RowBand{49, 1}, RowBand{7, 31}}) {
        Plane decoded = empty_plane(format(), 9, 50);
        EXPECT_TRUE(decode_strip(encode_strip(plane, band, {.encoding = {codec()}}), band, {}, decoded));
    }
}

TEST_P(EveryCodec, SameInputSameBytes) {
    const Plane plane = ramp_plane(format(), 50, 60);
    EXPECT_EQ(encode_strip(plane, {0, 60}, {.encoding = {codec()}}),
              encode_strip(plane, {0, 60}, {.encoding = {codec()}}));
}

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
    return name_of(std::get<0>(info.param)) + (std::get<1>(info.param) == Codec::kRaw ? "_raw" : "_zstd");
}

INSTANTIATE_TEST_SUITE_P(PlaneCodec, EveryCodec,
                         ::testing::Combine(::testing::ValuesIn(kAllFormats),
                                            ::testing::Values(Codec::kRaw, Codec::kZstdFiltered)),
                         case_name);

TEST(PlaneCodec, CompressesSmoothPlanes) {
    for (const PlaneFormat format : kAllFormats) {
        const Plane plane = ramp_plane(format, 320, 120);
        const auto strip = encode_strip(plane, {0, 120}, {});
        // One bit of noise per pixel and byte remains; ids are not predicted, so only their ramps repeat.
        EXPECT_LT(strip.size(), plane.bytes.size() * 4 / 5) << name_of(format);
    }
}

TEST(PlaneCodec, FallsBackToRawForNoise) {
    const Plane plane = random_plane(PlaneFormat::kRgb8, 40, 40);
    const auto strip = encode_strip(plane, {0, 40}, {});
    EXPECT_EQ(strip.size(), max_strip_bytes(PlaneFormat::kRgb8, 40, 40));
    EXPECT_EQ(strip[1], static_cast<std::byte>(Codec::kRaw));
}

class Referring : public ::testing::TestWithParam<PlaneFormat> {
protected:
    /// The coding of the strip, after a round trip.
    static StripHeader encode(const Plane& plane, const Plane& reference, Codec codec = Codec::kZstdFiltered) {
        const RowBand band{0, plane.height_px};
        const auto strip = encode_strip(plane, band, {.encoding = {codec}, .reference = &reference});
        Plane decoded = empty_plane(plane.format, plane.width_px, plane.height_px);
        const auto result = decode_strip(strip, band, {.reference = &reference}, decoded);
        EXPECT_TRUE(result) << result.error().message;
        EXPECT_TRUE(decoded == plane);
        const auto header = read_header(strip);
        EXPECT_TRUE(header);
        EXPECT_EQ(needs_reference(strip), header->needs_reference());
        if (header->needs_reference()) {
            EXPECT_FALSE(decode_strip(strip, band, {}, decoded));
        }
        return *header;
    }
};

TEST_P(Referring, EqualRowsAreRepeated) {
    const Plane plane = random_plane(GetParam(), 40, 50);
    for (const Codec codec : {Codec::kRaw, Codec::kZstdFiltered}) {
        const StripHeader header = encode(plane, plane, codec);
        EXPECT_EQ(header.coding, StripCoding::kRepeat);
        EXPECT_EQ(header.body_bytes, 0U);
    }
}

TEST_P(Referring, SmallChangesAreSentAsDifferences) {
    const Plane reference = random_plane(GetParam(), 40, 50);
    Plane plane = reference;
    for (std::size_t i = 0; i < plane.bytes.size(); i += 16) {
        plane.bytes[i] ^= std::byte{1};
    }
    const StripHeader header = encode(plane, reference);
    EXPECT_EQ(header.coding, StripCoding::kZstdFiltered);
    EXPECT_EQ(header.filter.predictor, Predictor::kReference);
    EXPECT_LT(header.body_bytes, plane.bytes.size() / 4); // noise alone does not compress at all
}

TEST_P(Referring, OtherPicturesArePredictedFromNeighbours) {
    const StripHeader header = encode(ramp_plane(GetParam(), 40, 50), random_plane(GetParam(), 40, 50));
    EXPECT_FALSE(header.needs_reference());
}

std::string format_name(const ::testing::TestParamInfo<PlaneFormat>& info) {
    return name_of(info.param);
}

INSTANTIATE_TEST_SUITE_P(PlaneCodec, Referring, ::testing::ValuesIn(kAllFormats), format_name);

TEST(PlaneCodec, JpegFallsBackToRawWhereItIsLarger) {
    const Plane plane = random_plane(PlaneFormat::kRgb8, 4, 4); // 48 bytes; the tables of a JPEG alone are larger
    const auto strip = encode_strip(plane, {0, 4}, {.encoding = {Codec::kJpeg, 75}});
    EXPECT_EQ(strip[1], static_cast<std::byte>(StripCoding::kRaw));
    Plane decoded = empty_plane(PlaneFormat::kRgb8, 4, 4);
    ASSERT_TRUE(decode_strip(strip, {0, 4}, {.codec = Codec::kJpeg}, decoded));
    EXPECT_TRUE(decoded == plane);
}

TEST(PlaneCodec, JpegRepeatsWhatTheReceiverHas) {
    const Plane sent = ramp_plane(PlaneFormat::kRgb8, 64, 48);
    const RowBand band{0, 48};
    const auto first = encode_strip(sent, band, {.encoding = {Codec::kJpeg, 75}});
    EXPECT_EQ(first[1], static_cast<std::byte>(StripCoding::kJpeg));
    Plane received = empty_plane(PlaneFormat::kRgb8, 64, 48);
    ASSERT_TRUE(decode_strip(first, band, {.codec = Codec::kJpeg}, received));
    const auto second = encode_strip(sent, band, {.encoding = {Codec::kJpeg, 75}, .reference = &sent});
    EXPECT_EQ(second.size(), kStripHeaderBytes);
    Plane again = empty_plane(PlaneFormat::kRgb8, 64, 48);
    ASSERT_TRUE(decode_strip(second, band, {.codec = Codec::kJpeg, .reference = &received}, again));
    EXPECT_TRUE(again == received);
}

TEST(PlaneCodec, JpegTakesLight) {
    const Plane plane = light_plane(96, 48);
    const auto strip = encode_strip(plane, {0, 48}, {.encoding = {Codec::kJpeg, 90}, .exposure = 2.0F});
    EXPECT_EQ(strip[1], static_cast<std::byte>(StripCoding::kJpeg));
    EXPECT_LT(strip.size(), plane.bytes.size() / 4);
    Plane decoded = empty_plane(plane.format, 96, 48);
    const auto result = decode_strip(strip, {0, 48}, {.codec = Codec::kJpeg}, decoded);
    ASSERT_TRUE(result) << result.error().message;
    double error = 0.0;
    for (std::size_t i = 0; i < 96 * 48; ++i) {
        const int green = green_bits(plane, i);
        error += green != 0 ? std::abs(green_bits(decoded, i) - green) : 0.0;
    }
    // Bits of the float: 64 are an octave. Steps of 2 in samples are about a tenth of an octave each here.
    EXPECT_LT(error / (96.0 * 48.0), 6.0);
}

TEST(PlaneCodec, BrighterExposureSpendsMoreOnDarkLight) {
    const Plane plane = light_plane(96, 48);
    const auto knee = [&](float exposure) {
        const auto strip = encode_strip(plane, {0, 48}, {.encoding = {Codec::kJpeg, 90}, .exposure = exposure});
        return decode_curve(std::span(strip).subspan(kStripHeaderBytes))->knee;
    };
    EXPECT_FLOAT_EQ(knee(1.0F) / knee(8.0F), 8.0F);
}

TEST(PlaneCodec, JpegIsForPicturesAndLight) {
    for (const PlaneFormat format : kAllFormats) {
        const bool is_picture = format == PlaneFormat::kRgb8 || format == PlaneFormat::kR11G11B10F;
        EXPECT_EQ(carries(Codec::kJpeg, format), is_picture) << name_of(format);
        EXPECT_TRUE(carries(Codec::kZstdFiltered, format) && carries(Codec::kRaw, format));
    }
}

TEST(PlaneCodec, StripBandsCoverEveryRow) {
    EXPECT_EQ(strip_bands(720).size(), 6U);
    EXPECT_EQ(strip_bands(1), (std::vector<RowBand>{{0, 1}}));
    EXPECT_EQ(strip_bands(121), (std::vector<RowBand>{{0, 120}, {120, 1}}));
    EXPECT_TRUE(strip_bands(0).empty());
}

TEST(PlaneCodec, RefusesToAllocateOversizedPlanes) {
    const auto allocate = [](std::uint32_t width, std::uint32_t height) {
        return allocate_plane(PlaneSemantic::kDepth, PlaneFormat::kF32, width, height).has_value();
    };
    EXPECT_TRUE(allocate(16, 16));
    EXPECT_FALSE(allocate(0, 16));
    EXPECT_FALSE(allocate(16, 0));
    EXPECT_FALSE(allocate(kMaxPlaneSide + 1, 1));
    EXPECT_FALSE(allocate(kMaxPlaneSide, kMaxPlaneSide)); // 1 GiB
    EXPECT_FALSE(allocate(0xFFFFFFFF, 0xFFFFFFFF));
    EXPECT_FALSE(allocate_plane(PlaneSemantic::kDepth, static_cast<PlaneFormat>(0), 4, 4));
}

TEST(PlaneCodec, KnowsItsNumbers) {
    EXPECT_EQ(from_number<Codec>(1), Codec::kRaw);
    EXPECT_EQ(from_number<Codec>(2), Codec::kZstdFiltered);
    EXPECT_EQ(from_number<Codec>(3), Codec::kJpeg);
    EXPECT_EQ(from_number<Codec>(4), Codec::kH264);
    for (const std::uint64_t number : {0ULL, 5ULL, 255ULL, 257ULL, 1ULL << 40}) {
        EXPECT_FALSE(from_number<Codec>(number)) << number;
    }
}

} // namespace
} // namespace fieldcast::codec
