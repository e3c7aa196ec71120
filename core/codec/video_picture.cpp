// SPDX-License-Identifier: Apache-2.0
// Conversion by ITU-R BT.709-6, items 3.2 to 3.5, in fixed point.
#include "core/codec/video_picture.h"

#include <algorithm>
#include <array>

namespace fieldcast::codec {

namespace {

constexpr std::uint32_t kMinSide = 16; ///< a macroblock

constexpr double kRedWeight = 0.2126;
constexpr double kBlueWeight = 0.0722;
constexpr double kGreenWeight = 1.0 - kRedWeight - kBlueWeight;
constexpr double kLumaScale = 219.0 / 255.0;
constexpr double kChromaScale = 224.0 / 255.0;
constexpr int kBits = 14;
constexpr int kHalf = 1 << (kBits - 1);

constexpr int fixed(double value) {
    return static_cast<int>(value * (1 << kBits) + (value < 0 ? -0.5 : 0.5));
}

std::uint8_t clamped(int value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0, 255));
}

struct Rgb {
    int red = 0;
    int green = 0;
    int blue = 0;
};

Rgb pixel_at(std::span<const std::byte> rgb, RgbSize size, std::uint32_t x, std::uint32_t y) {
    const std::size_t row = std::min(y, size.row_count - 1);
    const std::size_t at = 3 * (row * size.width_px + std::min(x, size.width_px - 1));
    return {std::to_integer<int>(rgb[at]), std::to_integer<int>(rgb[at + 1]), std::to_integer<int>(rgb[at + 2])};
}

std::uint8_t luma_of(const Rgb& c) {
    constexpr int kRed = fixed(kRedWeight * kLumaScale);
    constexpr int kGreen = fixed(kGreenWeight * kLumaScale);
    constexpr int kBlue = fixed(kBlueWeight * kLumaScale);
    return clamped(16 + ((kRed * c.red + kGreen * c.green + kBlue * c.blue + kHalf) >> kBits));
}

/// Cb and Cr of the sum of four pixels.
std::array<std::uint8_t, 2> chroma_of(const Rgb& sum) {
    constexpr double kToBlue = kChromaScale / (2.0 * (1.0 - kBlueWeight)) / 4.0;
    constexpr double kToRed = kChromaScale / (2.0 * (1.0 - kRedWeight)) / 4.0;
    const int blue = fixed(-kRedWeight * kToBlue) * sum.red + fixed(-kGreenWeight * kToBlue) * sum.green +
                     fixed((1.0 - kBlueWeight) * kToBlue) * sum.blue;
    const int red = fixed((1.0 - kRedWeight) * kToRed) * sum.red + fixed(-kGreenWeight * kToRed) * sum.green +
                    fixed(-kBlueWeight * kToRed) * sum.blue;
    return {clamped(128 + ((blue + kHalf) >> kBits)), clamped(128 + ((red + kHalf) >> kBits))};
}

/// Bilinear, with weights 9, 3, 3 and 1 over 16: a pixel lies a quarter of a sample from the nearest one.
int interpolated(VideoChannel channel, std::uint32_t last_x, std::uint32_t last_y, std::uint32_t x, std::uint32_t y) {
    const auto other = [](std::uint32_t at, std::uint32_t last) {
        const std::uint32_t near = at / 2;
        return at % 2 == 0 ? near - std::min(near, 1U) : std::min(near + 1, last);
    };
    const std::uint8_t* const near = channel.samples + y / 2 * channel.stride;
    const std::uint8_t* const far = channel.samples + other(y, last_y) * channel.stride;
    const std::uint32_t far_x = other(x, last_x);
    return (9 * near[x / 2] + 3 * near[far_x] + 3 * far[x / 2] + far[far_x] + 8) / 16;
}

} // namespace

std::uint32_t video_side(std::uint32_t side_px) {
    return std::max(side_px + side_px % 2, kMinSide);
}

VideoPicture video_from_rgb(std::span<const std::byte> rgb, RgbSize size) {
    VideoPicture picture{.width_px = video_side(size.width_px),
                         .height_px = video_side(size.row_count),
                         .luma = {},
                         .blue = {},
                         .red = {}};
    const std::size_t pixels = std::size_t{picture.width_px} * picture.height_px;
    picture.luma.resize(pixels);
    picture.blue.reserve(pixels / 4);
    picture.red.reserve(pixels / 4);
    for (std::uint32_t y = 0; y < picture.height_px; y += 2) {
        for (std::uint32_t x = 0; x < picture.width_px; x += 2) {
            Rgb sum;
            for (std::uint32_t i = 0; i < 4; ++i) {
                const Rgb c = pixel_at(rgb, size, x + i % 2, y + i / 2);
                picture.luma[std::size_t{y + i / 2} * picture.width_px + x + i % 2] = luma_of(c);
                sum = {sum.red + c.red, sum.green + c.green, sum.blue + c.blue};
            }
            const auto [blue, red] = chroma_of(sum);
            picture.blue.push_back(blue);
            picture.red.push_back(red);
        }
    }
    return picture;
}

void rgb_from_video(VideoChannel luma, VideoChannel blue, VideoChannel red, RgbSize size, std::span<std::byte> rgb) {
    constexpr int kLuma = fixed(1.0 / kLumaScale);
    constexpr int kRedOfRed = fixed(2.0 * (1.0 - kRedWeight) / kChromaScale);
    constexpr int kBlueOfBlue = fixed(2.0 * (1.0 - kBlueWeight) / kChromaScale);
    constexpr int kGreenOfRed = fixed(-2.0 * (1.0 - kRedWeight) * kRedWeight / kGreenWeight / kChromaScale);
    constexpr int kGreenOfBlue = fixed(-2.0 * (1.0 - kBlueWeight) * kBlueWeight / kGreenWeight / kChromaScale);
    const std::uint32_t last_x = video_side(size.width_px) / 2 - 1;
    const std::uint32_t last_y = video_side(size.row_count) / 2 - 1;
    std::size_t at = 0;
    for (std::uint32_t y = 0; y < size.row_count; ++y) {
        for (std::uint32_t x = 0; x < size.width_px; ++x) {
            const int bright = kLuma * (luma.samples[y * luma.stride + x] - 16) + kHalf;
            const int cb = interpolated(blue, last_x, last_y, x, y) - 128;
            const int cr = interpolated(red, last_x, last_y, x, y) - 128;
            rgb[at++] = std::byte{clamped((bright + kRedOfRed * cr) >> kBits)};
            rgb[at++] = std::byte{clamped((bright + kGreenOfRed * cr + kGreenOfBlue * cb) >> kBits)};
            rgb[at++] = std::byte{clamped((bright + kBlueOfBlue * cb) >> kBits)};
        }
    }
}

} // namespace fieldcast::codec
