// SPDX-License-Identifier: Apache-2.0
#include "core/codec/light_curve.h"

#include "core/codec/channel_layout.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fieldcast::codec {

namespace {

constexpr float kKneeOfDisplay = 0.05F; ///< as a share of the light that is shown as white
constexpr float kSmallest = 0x1p-40F;   ///< limits of knees and tops; the smallest value of the format is 2^−20
constexpr float kLargest = 0x1p40F;
constexpr std::uint32_t kPixelBytes = 4;

constexpr std::array kMantissaBits{6, 6, 5};
constexpr std::array kShift{0, 11, 22}; ///< of red, green, blue in a pixel

/// Finite values of unsigned floats with 5 exponent bits, ascending: the index is the bits.
std::vector<float> make_values(int mantissa_bits) {
    std::vector<float> values(std::size_t{31} << mantissa_bits);
    for (std::size_t bits = 0; bits < values.size(); ++bits) {
        const int exponent = static_cast<int>(bits >> mantissa_bits);
        const auto mantissa = static_cast<float>(bits & ((std::size_t{1} << mantissa_bits) - 1));
        const float implicit = exponent == 0 ? 0.0F : std::ldexp(1.0F, mantissa_bits);
        values[bits] = std::ldexp(implicit + mantissa, std::max(exponent, 1) - 15 - mantissa_bits);
    }
    return values;
}

const std::vector<float>& values_of_channel(std::size_t channel) {
    static const std::vector<float> fine = make_values(kMantissaBits[0]);
    static const std::vector<float> coarse = make_values(kMantissaBits[2]);
    return channel == 2 ? coarse : fine;
}

std::uint32_t mask_of_channel(std::size_t channel) {
    return (1U << (kMantissaBits[channel] + 5)) - 1U;
}

/// Bits of the nearest finite value.
std::uint32_t nearest(const std::vector<float>& values, float value) {
    const auto above = std::lower_bound(values.begin(), values.end(), value);
    if (above == values.begin()) {
        return 0;
    }
    const bool is_lower_nearer = above == values.end() || value - *(above - 1) < *above - value;
    return static_cast<std::uint32_t>(above - values.begin()) - (is_lower_nearer ? 1U : 0U);
}

/// Sample of every bit pattern of a channel.
std::vector<std::byte> make_samples(const LightCurve& curve, std::size_t channel) {
    const std::vector<float>& values = values_of_channel(channel);
    const float scale = 255.0F / std::log1p(curve.top / curve.knee);
    std::vector<std::byte> samples(std::size_t{mask_of_channel(channel)} + 1, std::byte{0}); // NaN: 0
    for (std::size_t bits = 0; bits < values.size(); ++bits) {
        const float sample = scale * std::log1p(values[bits] / curve.knee);
        samples[bits] = static_cast<std::byte>(std::lround(std::clamp(sample, 0.0F, 255.0F)));
    }
    samples[values.size()] = std::byte{255}; // infinity
    return samples;
}

/// Bits of every sample of a channel, where they stand in a pixel.
std::array<std::uint32_t, 256> make_bits(const LightCurve& curve, std::size_t channel) {
    const std::vector<float>& values = values_of_channel(channel);
    const float scale = std::log1p(curve.top / curve.knee) / 255.0F;
    std::array<std::uint32_t, 256> bits{};
    for (std::size_t sample = 1; sample < bits.size(); ++sample) {
        const float value = curve.knee * std::expm1(scale * static_cast<float>(sample));
        bits[sample] = nearest(values, value) << kShift[channel];
    }
    return bits;
}

float largest_value(std::span<const std::byte> pixels) {
    std::array<std::uint32_t, 3> largest{};
    for (std::size_t i = 0; i + kPixelBytes <= pixels.size(); i += kPixelBytes) {
        const auto pixel = load_word<std::uint32_t>(&pixels[i]);
        for (std::size_t c = 0; c < 3; ++c) { // patterns from values.size() on are no finite values
            const std::uint32_t bits = pixel >> kShift[c] & mask_of_channel(c);
            largest[c] = bits < 31U << kMantissaBits[c] ? std::max(largest[c], bits) : largest[c];
        }
    }
    float value = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
        value = std::max(value, values_of_channel(c)[largest[c]]);
    }
    return value;
}

bool is_usable(float value) {
    return std::isfinite(value) && value >= kSmallest && value <= kLargest;
}

} // namespace

LightCurve light_curve_for(std::span<const std::byte> pixels, float exposure) {
    const float knee = std::clamp(kKneeOfDisplay / exposure, kSmallest, kLargest);
    return {knee, std::clamp(largest_value(pixels), kSmallest, kLargest)};
}

std::array<std::byte, kLightCurveBytes> encode_curve(const LightCurve& curve) {
    std::array<std::byte, kLightCurveBytes> bytes{};
    store_word(bytes.data(), curve.knee);
    store_word(bytes.data() + sizeof(float), curve.top);
    return bytes;
}

Decoded<LightCurve> decode_curve(std::span<const std::byte> bytes) {
    if (bytes.size() < kLightCurveBytes) {
        return decode_error("strip: JPEG of light without its curve");
    }
    const LightCurve curve{load_word<float>(bytes.data()), load_word<float>(bytes.data() + sizeof(float))};
    if (!is_usable(curve.knee) || !is_usable(curve.top)) {
        return decode_error("strip: JPEG of light: knee or top outside 2^-40 to 2^40");
    }
    return curve;
}

void samples_from_light(const LightCurve& curve, std::span<const std::byte> pixels, std::span<std::byte> samples) {
    FC_ASSERT(pixels.size() / kPixelBytes == samples.size() / 3, "rows of another size");
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<std::byte> sample_of = make_samples(curve, c);
        const std::uint32_t mask = mask_of_channel(c);
        for (std::size_t i = 0; i < samples.size() / 3; ++i) {
            samples[3 * i + c] = sample_of[load_word<std::uint32_t>(&pixels[kPixelBytes * i]) >> kShift[c] & mask];
        }
    }
}

void light_from_samples(const LightCurve& curve, std::span<const std::byte> samples, std::span<std::byte> pixels) {
    FC_ASSERT(pixels.size() / kPixelBytes == samples.size() / 3, "rows of another size");
    const auto red = make_bits(curve, 0);
    const auto green = make_bits(curve, 1);
    const auto blue = make_bits(curve, 2);
    for (std::size_t i = 0; i < samples.size() / 3; ++i) {
        const auto sample = [&](std::size_t c) { return std::to_integer<std::size_t>(samples[3 * i + c]); };
        store_word(&pixels[kPixelBytes * i], red[sample(0)] | green[sample(1)] | blue[sample(2)]);
    }
}

} // namespace fieldcast::codec
