// SPDX-License-Identifier: Apache-2.0
// Usage: make_golden_strips FOLDER. Writes the strips that golden_test.cpp and malformed_strip_test.cpp read.
#include "core/codec/plane_codec.h"

#include "tests/wire/test_planes.h"

#include <filesystem>
#include <fstream>
#include <span>

namespace {

using namespace fieldcast;

using Bytes = std::vector<std::byte>;

void write(const std::filesystem::path& file, const Bytes& bytes) {
    std::ofstream stream(file, std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void write_valid(const std::filesystem::path& folder) {
    for (const PlaneFormat format : testing::kAllFormats) {
        const Plane plane = testing::ramp_plane(format, 33, 20);
        const std::string name = testing::name_of(format);
        const Plane reference = testing::ramp_plane(format, 33, 20, 1);
        codec::ByteFilter temporal = codec::filter_for(format);
        temporal.predictor = codec::Predictor::kReference;
        const auto encode = [&](const codec::StripOptions& options) {
            return codec::encode_strip(plane, {3, 15}, options);
        };
        write(folder / (name + "_raw.strip"), encode({.encoding = {Codec::kRaw}}));
        write(folder / (name + "_zstd.strip"), encode({.filter = testing::first_filter(format)}));
        write(folder / (name + "_predicted.strip"), encode({}));
        write(folder / (name + "_reference.strip"), encode({.reference = &reference, .filter = temporal}));
        write(folder / (name + "_repeat.strip"), encode({.reference = &plane}));
    }
    const Plane picture = testing::ramp_plane(PlaneFormat::kRgb8, 33, 20);
    write(folder / "rgb8_jpeg.strip", codec::encode_strip(picture, {3, 15}, {.encoding = {Codec::kJpeg, 95}}));
    Plane soft = testing::empty_plane(PlaneFormat::kRgb8, 33, 20); // as in h264_strip_test.cpp
    Plane moved = soft;
    for (std::size_t i = 0; i < soft.bytes.size(); ++i) {
        const auto pixel = static_cast<std::uint32_t>(i / 3);
        soft.bytes[i] = static_cast<std::byte>(4 * (pixel % 33) + 3 * (pixel / 33));
        moved.bytes[i] = static_cast<std::byte>(4 * (pixel % 33 + 2) + 3 * (pixel / 33));
    }
    write(folder / "rgb8_h264.strip", codec::encode_strip(soft, {3, 15}, {.encoding = {Codec::kH264, 75}}));
    write(folder / "rgb8_h264_predicted.strip",
          codec::encode_strip(moved, {3, 15}, {.encoding = {Codec::kH264, 75}, .base = &soft}));
    write(folder / "r11g11b10f_jpeg.strip",
          codec::encode_strip(testing::light_plane(33, 20), {3, 15}, {.encoding = {Codec::kJpeg, 95}}));
}

Bytes with_byte(Bytes strip, std::size_t at, std::uint8_t value) {
    strip[at] = std::byte{value};
    return strip;
}

/// The header of `strip`, but for its size field, and another body.
Bytes with_body(const Bytes& strip, std::span<const std::byte> body) {
    Bytes changed(strip.begin(), strip.begin() + codec::kStripHeaderBytes);
    changed.insert(changed.end(), body.begin(), body.end());
    for (unsigned i = 0; i < 4; ++i) {
        changed[12 + i] = static_cast<std::byte>(body.size() >> (8 * i));
    }
    return changed;
}

void write_malformed(const std::filesystem::path& folder) {
    const Plane plane = testing::ramp_plane(PlaneFormat::kRgb8, 33, 20);
    const Bytes zstd = codec::encode_strip(plane, {3, 15}, {.filter = testing::first_filter(plane.format)});
    const Bytes raw = codec::encode_strip(plane, {3, 15}, {.encoding = {Codec::kRaw}});
    const Bytes repeat = codec::encode_strip(plane, {3, 15}, {.reference = &plane});
    const auto body = std::span(zstd).subspan(codec::kStripHeaderBytes);
    write(folder / "empty.strip", {});
    write(folder / "truncated_header.strip", Bytes(zstd.begin(), zstd.begin() + 15));
    write(folder / "truncated_body.strip", Bytes(zstd.begin(), zstd.end() - 1));
    write(folder / "version.strip", with_byte(zstd, 0, 2));
    write(folder / "codec.strip", with_byte(zstd, 1, 9));
    write(folder / "format.strip", with_byte(zstd, 2, 7));
    write(folder / "other_format.strip", with_byte(zstd, 2, 5));
    write(folder / "predictor.strip", with_byte(zstd, 3, 5));
    write(folder / "word.strip", with_byte(zstd, 4, 2));
    write(folder / "flags.strip", with_byte(zstd, 5, 2));
    write(folder / "raw_flags.strip", with_byte(raw, 5, 1));
    write(folder / "floats_layout.strip", with_byte(zstd, 4, 11));
    write(folder / "reference.strip", with_byte(zstd, 3, 4));
    write(folder / "repeat.strip", repeat);
    write(folder / "repeat_filter.strip", with_byte(repeat, 3, 4));
    write(folder / "repeat_body.strip", with_body(repeat, std::span(raw).subspan(16, 1)));
    write(folder / "width.strip", with_byte(zstd, 6, 32));
    write(folder / "rows.strip", with_byte(zstd, 10, 16));
    write(folder / "raw_filter.strip", with_byte(raw, 3, 1));
    const Bytes jpeg = codec::encode_strip(plane, {3, 15}, {.encoding = {Codec::kJpeg, 95}});
    write(folder / "jpeg_filter.strip", with_byte(jpeg, 3, 1));
    write(folder / "jpeg_cut.strip", with_body(jpeg, std::span(jpeg).subspan(16, jpeg.size() - 20)));
    write(folder / "jpeg_in_zstd_plane.strip", jpeg);
    const Bytes light = codec::encode_strip(testing::light_plane(33, 20), {3, 15}, {.encoding = {Codec::kJpeg, 95}});
    write(folder / "light_no_curve.strip", with_body(light, std::span(light).subspan(16, 7)));
    write(folder / "light_no_picture.strip", with_body(light, std::span(light).subspan(16, 8)));
    write(folder / "light_negative_knee.strip", with_byte(light, 19, 0xBD));
    write(folder / "light_infinite_top.strip", with_byte(with_byte(light, 22, 0x80), 23, 0x7F));
    write(folder / "raw_short.strip", with_body(raw, std::span(raw).subspan(16, 100)));
    Bytes twice(body.begin(), body.end());
    twice.insert(twice.end(), body.begin(), body.end());
    write(folder / "two_frames.strip", with_body(zstd, twice));
    write(folder / "cut_frame.strip", with_body(zstd, body.first(body.size() - 1)));
    // zstd frame header: magic, descriptor with 8 bytes of content size and one segment, 1 TiB
    const Bytes bomb{std::byte{0x28}, std::byte{0xB5}, std::byte{0x2F}, std::byte{0xFD}, std::byte{0xE0}, std::byte{0},
                     std::byte{0},    std::byte{0},    std::byte{0},    std::byte{0},    std::byte{1},    std::byte{0},
                     std::byte{0},    std::byte{1},    std::byte{0},    std::byte{0}};
    write(folder / "huge_content.strip", with_body(zstd, bomb));
    const Plane larger = testing::ramp_plane(PlaneFormat::kRgb8, 33, 16);
    const Bytes other = codec::encode_strip(larger, {0, 16}, {.filter = testing::first_filter(plane.format)});
    write(folder / "other_content.strip", with_body(zstd, std::span(other).subspan(codec::kStripHeaderBytes)));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder / "malformed");
    write_valid(folder);
    write_malformed(folder / "malformed");
    return 0;
}
