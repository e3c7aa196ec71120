// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

// The layouts of byte_filter.h as types: how a row of pixels becomes rows of channel values ("lanes", channel after
// channel), and how lanes of prediction errors become byte planes. docs/protocol.md, "Strips", steps 1 and 4.
namespace fieldcast::codec {

static_assert(std::endian::native == std::endian::little, "pixels are little-endian in memory and on the wire");

template <class Word> Word load_word(const std::byte* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

template <class Word> void store_word(std::byte* bytes, Word word) {
    std::memcpy(bytes, &word, sizeof word);
}

/// `kCount` words per pixel, each a channel of its own.
template <class Word, std::size_t kCount> struct WordChannels {
    using Lane = Word;
    static constexpr std::size_t kChannels = kCount;
    static constexpr std::size_t kPixelBytes = kCount * sizeof(Word);
    static constexpr int bits(std::size_t) { return 8 * sizeof(Word); }

    static void load(const std::byte* row, std::size_t width, Lane* lanes) {
        if constexpr (sizeof(Word) == 1 && kCount == 4) { // shifts and packs vectorise, strided byte loads do not
            for (std::size_t c = 0; c < kCount; ++c) {
                for (std::size_t i = 0; i < width; ++i) {
                    lanes[c * width + i] = static_cast<Lane>(load_word<std::uint32_t>(row + 4 * i) >> (8 * c));
                }
            }
        } else {
            for (std::size_t i = 0; i < width; ++i) {
                for (std::size_t c = 0; c < kCount; ++c) {
                    lanes[c * width + i] = load_word<Word>(row + (i * kCount + c) * sizeof(Word));
                }
            }
        }
    }

    static void store(const Lane* lanes, std::size_t width, std::byte* row) {
        for (std::size_t i = 0; i < width; ++i) {
            for (std::size_t c = 0; c < kCount; ++c) {
                store_word(row + (i * kCount + c) * sizeof(Word), lanes[c * width + i]);
            }
        }
    }

    static void split(const Lane* errors, std::size_t width, std::byte* planes, std::size_t stride) {
        for (std::size_t c = 0; c < kCount; ++c) {
            for (std::size_t b = 0; b < sizeof(Word); ++b) {
                std::byte* plane = planes + (c * sizeof(Word) + b) * stride;
                for (std::size_t i = 0; i < width; ++i) {
                    plane[i] = static_cast<std::byte>(errors[c * width + i] >> (8 * b));
                }
            }
        }
    }

    static void join(const std::byte* planes, std::size_t stride, std::size_t width, Lane* errors) {
        for (std::size_t c = 0; c < kCount; ++c) {
            for (std::size_t i = 0; i < width; ++i) {
                std::uint32_t word = 0;
                for (std::size_t b = 0; b < sizeof(Word); ++b) {
                    word |= std::to_integer<std::uint32_t>(planes[(c * sizeof(Word) + b) * stride + i]) << (8 * b);
                }
                errors[c * width + i] = static_cast<Lane>(word);
            }
        }
    }
};

/// kRgb8 relative to green, modulo 256: grey pixels have 128 in the other two channels.
struct GreenByteChannels : WordChannels<std::uint8_t, 3> {
    static void load(const std::byte* row, std::size_t width, Lane* lanes) {
        for (std::size_t i = 0; i < width; ++i) {
            const auto red = std::to_integer<unsigned>(row[3 * i]);
            const auto green = std::to_integer<unsigned>(row[3 * i + 1]);
            const auto blue = std::to_integer<unsigned>(row[3 * i + 2]);
            lanes[i] = static_cast<Lane>(green);
            lanes[width + i] = static_cast<Lane>(red - green + 128);
            lanes[2 * width + i] = static_cast<Lane>(blue - green + 128);
        }
    }

    static void store(const Lane* lanes, std::size_t width, std::byte* row) {
        for (std::size_t i = 0; i < width; ++i) {
            const unsigned green = lanes[i];
            row[3 * i] = static_cast<std::byte>(lanes[width + i] + green - 128);
            row[3 * i + 1] = static_cast<std::byte>(green);
            row[3 * i + 2] = static_cast<std::byte>(lanes[2 * width + i] + green - 128);
        }
    }
};

/// kR11G11B10F by its fields. The bits of a small float grow like its logarithm, so differences of channels are ratios
/// of colours, which vary little. Blue has one mantissa bit less.
struct PackedFloatChannels {
    using Lane = std::uint16_t;
    static constexpr std::size_t kChannels = 3;
    static constexpr std::size_t kPixelBytes = 4;
    static constexpr int bits(std::size_t channel) { return channel == 2 ? 10 : 11; }

    static void load(const std::byte* row, std::size_t width, Lane* lanes) {
        for (std::size_t i = 0; i < width; ++i) {
            const auto pixel = load_word<std::uint32_t>(row + 4 * i);
            const std::uint32_t green = (pixel >> 11) & 0x7FF;
            lanes[i] = static_cast<Lane>(green);
            lanes[width + i] = static_cast<Lane>((pixel - green + 0x400) & 0x7FF);
            lanes[2 * width + i] = static_cast<Lane>(((pixel >> 22) - (green >> 1) + 0x200) & 0x3FF);
        }
    }

    static void store(const Lane* lanes, std::size_t width, std::byte* row) {
        for (std::size_t i = 0; i < width; ++i) {
            const std::uint32_t green = lanes[i];
            const std::uint32_t red = (lanes[width + i] + green - 0x400) & 0x7FF;
            const std::uint32_t blue = (lanes[2 * width + i] + (green >> 1) - 0x200) & 0x3FF;
            store_word(row + 4 * i, red | green << 11 | blue << 22);
        }
    }

    /// Low bytes of the three channels, then a plane of their high bits: 3 of green, 3 of red, 2 of blue.
    static void split(const Lane* errors, std::size_t width, std::byte* planes, std::size_t stride) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            for (std::size_t i = 0; i < width; ++i) {
                planes[c * stride + i] = static_cast<std::byte>(errors[c * width + i]);
            }
        }
        for (std::size_t i = 0; i < width; ++i) {
            const int high = errors[i] >> 8 | (errors[width + i] >> 8) << 3 | (errors[2 * width + i] >> 8) << 6;
            planes[3 * stride + i] = static_cast<std::byte>(high);
        }
    }

    static void join(const std::byte* planes, std::size_t stride, std::size_t width, Lane* errors) {
        constexpr std::array<int, kChannels> kShift{0, 3, 6};
        for (std::size_t c = 0; c < kChannels; ++c) {
            const int most = (1 << (bits(c) - 8)) - 1;
            for (std::size_t i = 0; i < width; ++i) {
                const int high = std::to_integer<int>(planes[3 * stride + i]) >> kShift[c] & most;
                errors[c * width + i] = static_cast<Lane>(std::to_integer<int>(planes[c * stride + i]) | high << 8);
            }
        }
    }
};

} // namespace fieldcast::codec
