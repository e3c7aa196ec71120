// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_file.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"
#include "tests/unit/image/test_image.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <limits>
#include <string_view>
#include <thread>

namespace fieldcast::image {
namespace {

using test::image_bytes;
using testing::ElementsAre;
using testing::HasSubstr;

const ImageLimits kNoLimits{};

Rgba8 decode(const std::string& name) {
    return decode_rgba8(image_bytes(name), name, kNoLimits);
}

std::string decode_problem(std::span<const std::byte> bytes, const ImageLimits& limits = {}) {
    try {
        decode_rgba8(bytes, "lamp.png", limits);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(DecodeRgba8, FillsMissingAlpha) {
    EXPECT_THAT(decode("rgb8.png").pixels, ElementsAre(200, 100, 50, 255, 10, 20, 30, 255));
}

TEST(DecodeRgba8, KeepsColourUnderTransparentPixels) {
    EXPECT_THAT(decode("rgba8.png").pixels,
                ElementsAre(200, 100, 50, 0, 200, 100, 50, 128, 1, 2, 3, 1, 255, 254, 253, 255));
    EXPECT_EQ(decode("lossless.webp").pixels, decode("rgba8.png").pixels);
}

TEST(DecodeRgba8, Converts16BitImages) {
    EXPECT_THAT(decode("rgba16.png").pixels, ElementsAre(200, 100, 50, 3));
    EXPECT_THAT(decode("grey16.png").pixels,
                ElementsAre(0, 0, 0, 255, 128, 128, 128, 255, 255, 255, 255, 255, 18, 18, 18, 255));
}

TEST(DecodeRgba8, SpreadsGreyAndPalettes) {
    EXPECT_THAT(decode("grey_alpha8.png").pixels, ElementsAre(77, 77, 77, 0, 88, 88, 88, 200));
    EXPECT_THAT(decode("palette.png").pixels, ElementsAre(7, 8, 9, 255, 1, 2, 3, 0, 40, 50, 60, 128));
    const Rgba8 grey1 = decode("grey1.png");
    ASSERT_EQ(grey1.pixels.size(), 32U);
    EXPECT_EQ(grey1.pixels[0], 255);
    EXPECT_EQ(grey1.pixels[4], 0);
    EXPECT_EQ(grey1.pixels[8], 255);
}

TEST(DecodeRgba8, IgnoresGammaChunks) {
    EXPECT_THAT(decode("gamma.png").pixels, ElementsAre(200, 100, 50, 128));
}

TEST(DecodeRgba8, ReadsJpegAndLossyWebp) {
    for (const char* name : {"baseline.jpg", "progressive.jpg", "lossy.webp"}) {
        const Rgba8 image = decode(name);
        ASSERT_EQ(image.width_px, 16U) << name;
        ASSERT_EQ(image.height_px, 8U) << name;
        EXPECT_NEAR(image.pixels[0], 200, 2) << name; // quality 95 of a flat colour
        EXPECT_NEAR(image.pixels[1], 100, 2) << name;
        EXPECT_NEAR(image.pixels[2], 50, 2) << name;
        EXPECT_EQ(image.pixels[3], 255) << name;
    }
    EXPECT_EQ(decode("grey.jpg").pixels[2], 90);
    EXPECT_EQ(decode("extended.webp").pixels[7], 128);
}

TEST(DecodeRgba8, ChecksLimitsBeforeDecoding) {
    const ImageLimits limits{.max_pixels = 100};
    for (const char* name : {"baseline.jpg", "progressive.jpg", "lossy.webp"}) {
        EXPECT_THAT(decode_problem(image_bytes(name), limits),
                    HasSubstr("lamp.png: image of 16x8 pixels, at most 100"));
    }
    std::vector<std::byte> huge = image_bytes("rgb8.png");
    std::fill_n(huge.begin() + 17, 3, std::byte{0xFF}); // width
    std::fill_n(huge.begin() + 21, 3, std::byte{0xFF}); // height
    EXPECT_THAT(decode_problem(huge), HasSubstr("at most 67108864 pixels"));
    std::vector<std::byte> huge_webp = image_bytes("extended.webp");
    std::fill_n(huge_webp.begin() + 24, 6, std::byte{0xFF});
    EXPECT_THAT(decode_problem(huge_webp), HasSubstr("image of 16777216x16777216 pixels"));
}

TEST(DecodeRgba8, NamesWhatIsNoImage) {
    EXPECT_THAT(decode_problem({}), HasSubstr("lamp.png: not a PNG, JPEG or WebP image"));
    const std::vector<std::byte> text(100, std::byte{'x'});
    EXPECT_THAT(decode_problem(text), HasSubstr("not a PNG, JPEG or WebP image"));
}

/// A truncated JPEG or WebP may decode in part but must not crash; PNG and what has half a header is refused.
TEST(DecodeRgba8, SurvivesTruncationAtEveryByte) {
    for (const char* name : {"rgba8.png", "baseline.jpg", "progressive.jpg", "lossless.webp", "extended.webp"}) {
        const std::vector<std::byte> bytes = image_bytes(name);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const std::vector<std::byte> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
            const std::string problem = decode_problem(part);
            if (size < 24 || std::string_view(name).ends_with(".png")) {
                EXPECT_NE(problem, "") << name << " of " << size << " bytes";
            }
        }
    }
}

TEST(DecodeRgba8, SurvivesAnyDamagedByte) {
    for (const char* name : {"rgba8.png", "palette.png", "progressive.jpg", "lossy.webp", "extended.webp"}) {
        const std::vector<std::byte> bytes = image_bytes(name);
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            std::vector<std::byte> damaged = bytes;
            damaged[i] ^= std::byte{0xFF};
            decode_problem(damaged, ImageLimits{.max_pixels = 1 << 16}); // anything but UserError ends the test
        }
    }
}

TEST(DecodeRgba8, DecodesInParallel) {
    const std::vector<std::byte> bytes = image_bytes("rgba8.png");
    const Rgba8 expected = decode("rgba8.png");
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&] {
            for (int round = 0; round < 50; ++round) {
                EXPECT_EQ(decode_rgba8(bytes, "rgba8.png", kNoLimits).pixels, expected.pixels);
            }
        });
    }
}

TEST(WritePng, RoundTripsPlanesAndTransparency) {
    const test::TestFolder folder;
    Plane plane = test::flat_plane(3, 2, 7, 130, 255);
    plane.bytes[0] = std::byte{99};
    write_png(folder.path() / "plane.png", plane);
    const Rgba8 read = decode_rgba8(test::file_bytes(folder.path() / "plane.png"), "plane.png", kNoLimits);
    EXPECT_EQ(read.width_px, 3U);
    EXPECT_EQ(read.height_px, 2U);
    EXPECT_EQ(read.pixels[0], 99);
    EXPECT_EQ(read.pixels[4], 7);

    const Rgba8 transparent = decode("rgba8.png");
    write_png(folder.path() / "rgba.png", transparent);
    const auto bytes = test::file_bytes(folder.path() / "rgba.png");
    EXPECT_EQ(decode_rgba8(bytes, "rgba.png", kNoLimits).pixels, transparent.pixels);
    EXPECT_EQ(folder.file_count(), 2U) << "temporary files remain";
}

TEST(WritePng, SamePixelsGiveSameBytes) {
    const Plane plane = test::flat_plane(40, 30, 1, 2, 3);
    EXPECT_EQ(encode_png(plane), encode_png(plane));
}

TEST(WriteFileAtomically, KeepsTheOldFileWhenItFails) {
    const test::TestFolder folder;
    const auto missing = folder.path() / "no" / "such" / "folder.png";
    EXPECT_THROW(write_png(missing, test::flat_plane(1, 1, 0, 0, 0)), std::system_error);
    const auto occupied = folder.path() / "occupied";
    std::filesystem::create_directories(occupied / "child");
    EXPECT_THROW(write_file_atomically(occupied, image_bytes("rgb8.png")), std::system_error);
    EXPECT_EQ(folder.file_count(), 1U) << "temporary files remain";
}

RgbF32 ramp() {
    RgbF32 image{4, 3, {}};
    for (int i = 0; i < 12; ++i) {
        image.pixels.emplace_back(static_cast<float>(i) * 0.1F, static_cast<float>(i * i), 1e-7F);
    }
    return image;
}

TEST(ReadRgbF32, ReadsFloatExrExactly) {
    const test::TestFolder folder;
    write_exr(folder.path() / "ramp.exr", ramp());
    const RgbF32 read = read_rgb_f32(folder.path() / "ramp.exr", kNoLimits);
    EXPECT_EQ(read.width_px, 4U);
    EXPECT_EQ(read.height_px, 3U);
    EXPECT_EQ(read.pixels, ramp().pixels);
    EXPECT_THROW(read_rgb_f32(folder.path() / "ramp.exr", {.max_pixels = 11}), UserError);
}

TEST(ReadRgbF32, HalfFloatsKeepElevenBitsAndEndAtTheirLargest) {
    const test::TestFolder folder;
    RgbF32 image{2, 1, {glm::vec3(1.0F / 3.0F, 1000.7F, 0.0F), glm::vec3(1e6F, 6e-5F, 1.0F)}};
    write_exr(folder.path() / "light.exr", image, ExrPrecision::kHalf);
    const RgbF32 read = read_rgb_f32(folder.path() / "light.exr", kNoLimits);
    image.pixels[1].x = 65504.0F;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            const float value = image.pixels[i][channel];
            EXPECT_NEAR(read.pixels[i][channel], value, value / 2048) << i << ", " << channel; // half of the last bit
        }
    }
    EXPECT_NE(read.pixels[0].x, image.pixels[0].x);
}

TEST(ReadRgbF32, ClampsInfinityAndRefusesNanAndNegativeValues) {
    const test::TestFolder folder;
    const auto file = folder.path() / "light.exr";
    RgbF32 image = ramp();
    image.pixels[5].y = std::numeric_limits<float>::infinity();
    write_exr(file, image);
    EXPECT_EQ(read_rgb_f32(file, kNoLimits).pixels[5].y, 65504.0F);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -1e-6F}) {
        image.pixels[5].y = bad;
        write_exr(file, image);
        EXPECT_THROW(read_rgb_f32(file, kNoLimits), UserError);
    }
}

/// Writes `pixels` of `channels` floats each with OpenImageIO.
void write_with_oiio(const std::filesystem::path& file, int channels, const std::vector<float>& pixels) {
    const auto output = OIIO::ImageOutput::create(file.string());
    const int width = static_cast<int>(pixels.size()) / channels;
    ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(width, 1, channels, OIIO::TypeDesc::FLOAT)));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close());
}

TEST(ReadRgbF32, ReadsRadianceFilesGreyAndAlpha) {
    const test::TestFolder folder;
    write_with_oiio(folder.path() / "sky.hdr", 3, {0.5F, 1.0F, 2.0F, 0.0F, 0.0F, 64.0F});
    const RgbF32 sky = read_rgb_f32(folder.path() / "sky.hdr", kNoLimits);
    EXPECT_THAT(sky.pixels, ElementsAre(glm::vec3(0.5F, 1.0F, 2.0F), glm::vec3(0.0F, 0.0F, 64.0F)));
    write_with_oiio(folder.path() / "grey.exr", 1, {0.25F, 3.0F});
    EXPECT_THAT(read_rgb_f32(folder.path() / "grey.exr", kNoLimits).pixels,
                ElementsAre(glm::vec3(0.25F), glm::vec3(3.0F)));
    write_with_oiio(folder.path() / "rgba.exr", 4, {0.5F, 0.25F, 2.0F, 0.0F});
    EXPECT_THAT(read_rgb_f32(folder.path() / "rgba.exr", kNoLimits).pixels, ElementsAre(glm::vec3(0.5F, 0.25F, 2.0F)));
}

TEST(ReadRgbF32, RefusesOtherFiles) {
    EXPECT_THROW(read_rgb_f32("tests/unit/image/data/rgb8.png", kNoLimits), UserError);
    EXPECT_THROW(read_rgb_f32("no/such/file.exr", kNoLimits), UserError);
    const test::TestFolder folder;
    write_with_oiio(folder.path() / "two.exr", 2, {0.5F, 0.25F});
    EXPECT_THROW(read_rgb_f32(folder.path() / "two.exr", kNoLimits), UserError);
    write_file_atomically(folder.path() / "noise.exr", image_bytes("rgb8.png"));
    EXPECT_THROW(read_rgb_f32(folder.path() / "noise.exr", kNoLimits), UserError);
}

/// An EXR file of 3 × 2 pixels with `value` written `at` bytes behind the first `name` in it.
void write_changed_exr(const std::filesystem::path& file, const std::string& name, std::size_t at,
                       std::uint32_t value) {
    write_exr(file, RgbF32{3, 2, std::vector<glm::vec3>(6)});
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t found = bytes.find(name);
    ASSERT_NE(found, std::string::npos);
    stream.seekp(static_cast<std::streamoff>(found + name.size() + at));
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}

TEST(ReadRgbF32, RefusesHeadersThatClaimMoreThanThereIs) {
    const test::TestFolder folder;
    const auto file = folder.path() / "sky.exr";
    const auto refusal = [&](const std::string& name, std::size_t at, std::uint32_t value) -> std::string {
        write_changed_exr(file, name, at, value);
        try {
            read_rgb_f32(file, kNoLimits);
        } catch (const UserError& error) {
            return error.what();
        }
        return "nothing";
    };
    const std::string window("dataWindow\0box2i\0", 17);
    const std::string channels("channels\0chlist\0", 16);
    EXPECT_EQ(refusal(window, 4, 0), "nothing"); // its first corner is (0, 0) anyway
    EXPECT_THAT(refusal(channels, 0, 0x20000000), HasSubstr("larger than the header may be")); // 512 MiB
    EXPECT_THAT(refusal(window, 12, 0x7FFFFFFF), HasSubstr("pixels are accepted"));            // right edge
    EXPECT_THAT(refusal(window, 4, 0x80000000), HasSubstr("pixels are accepted"));             // left edge
    EXPECT_THAT(refusal(window, 12, 0xFFFFFFFF), HasSubstr("image of 0x2 pixels"));            // empty
    EXPECT_THAT(refusal(window, 16, 20'000'000), HasSubstr("in so small a file"));             // bottom edge
}

TEST(ReadRgbF32, LooksAtTheContentNotAtTheName) {
    const test::TestFolder folder;
    write_exr(folder.path() / "sky.hdr", RgbF32{1, 1, {glm::vec3(0.5F)}});
    EXPECT_EQ(read_rgb_f32(folder.path() / "sky.hdr", kNoLimits).pixels[0], glm::vec3(0.5F));
}

} // namespace
} // namespace fieldcast::image
