// SPDX-License-Identifier: Apache-2.0
#include "core/codec/byte_filter.h"

#include "core/base/error.h"

#include <array>
#include <bit>
#include <cstring>
#include <vector>

namespace fieldcast::codec {

namespace {

static_assert(std::endian::native == std::endian::little, "pixels are little-endian in memory and on the wire");

template <class Word> Word load(const std::byte* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

template <class Word> void store(std::byte* bytes, Word word) {
    std::memcpy(bytes, &word, sizeof word);
}

/// residual = row − up, minus the same of the pixel to the left. No value depends on another: vectorisable.
template <class Word, std::size_t kChannels>
void predict_row(const std::byte* row, const std::byte* up, std::size_t width, std::byte* residual) {
    constexpr std::size_t kPixelBytes = kChannels * sizeof(Word);
    for (std::size_t at = 0; at < kPixelBytes; at += sizeof(Word)) {
        store(residual + at, static_cast<Word>(load<Word>(row + at) - load<Word>(up + at)));
    }
    for (std::size_t at = kPixelBytes; at < width * kPixelBytes; at += sizeof(Word)) {
        const auto here = static_cast<Word>(load<Word>(row + at) - load<Word>(up + at));
        const auto left = static_cast<Word>(load<Word>(row + at - kPixelBytes) - load<Word>(up + at - kPixelBytes));
        store(residual + at, static_cast<Word>(here - left));
    }
}

/// One row of pixels → its part of every byte plane; the planes are `plane_stride` apart.
template <std::size_t kPixelBytes>
void split_row(const std::byte* row, std::size_t width, std::byte* planes, std::size_t plane_stride) {
    if constexpr (kPixelBytes == 4) { // whole words: shifts and packs vectorise, strided byte loads do not
        for (std::size_t b = 0; b < 4; ++b) {
            for (std::size_t i = 0; i < width; ++i) {
                planes[b * plane_stride + i] = static_cast<std::byte>(load<std::uint32_t>(row + 4 * i) >> (8 * b));
            }
        }
    } else {
        for (std::size_t i = 0; i < width; ++i) {
            for (std::size_t b = 0; b < kPixelBytes; ++b) {
                planes[b * plane_stride + i] = row[i * kPixelBytes + b];
            }
        }
    }
}

template <std::size_t kPixelBytes>
void join_row(const std::byte* planes, std::size_t plane_stride, std::size_t width, std::byte* row) {
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t b = 0; b < kPixelBytes; ++b) {
            row[i * kPixelBytes + b] = planes[b * plane_stride + i];
        }
    }
}

/// Undoes predict_row and split_row at once: running sums per channel, plus the row above.
template <class Word, std::size_t kChannels>
void restore_row(const std::byte* planes, std::size_t plane_stride, const std::byte* up, std::size_t width,
                 std::byte* row) {
    std::array<Word, kChannels> sum{};
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            Word residual = 0;
            for (std::size_t b = 0; b < sizeof(Word); ++b) {
                const std::byte byte = planes[(c * sizeof(Word) + b) * plane_stride + i];
                residual = static_cast<Word>(residual | (std::to_integer<Word>(byte) << (8 * b)));
            }
            sum[c] = static_cast<Word>(sum[c] + residual);
            const std::size_t at = (i * kChannels + c) * sizeof(Word);
            store(row + at, static_cast<Word>(sum[c] + load<Word>(up + at)));
        }
    }
}

/// The loops for one combination of word and channels.
struct RowFunctions {
    void (*predict)(const std::byte*, const std::byte*, std::size_t, std::byte*);
    void (*split)(const std::byte*, std::size_t, std::byte*, std::size_t);
    void (*join)(const std::byte*, std::size_t, std::size_t, std::byte*);
    void (*restore)(const std::byte*, std::size_t, const std::byte*, std::size_t, std::byte*);
};

template <class Word, std::size_t kChannels> constexpr RowFunctions row_functions() {
    constexpr std::size_t kPixelBytes = kChannels * sizeof(Word);
    return {predict_row<Word, kChannels>, split_row<kPixelBytes>, join_row<kPixelBytes>, restore_row<Word, kChannels>};
}

std::optional<RowFunctions> find_row_functions(std::uint32_t pixel_bytes, std::uint8_t word_bytes) {
    switch (pixel_bytes * 10 + word_bytes) {
    case 21:
        return row_functions<std::uint8_t, 2>();
    case 22:
        return row_functions<std::uint16_t, 1>();
    case 31:
        return row_functions<std::uint8_t, 3>();
    case 41:
        return row_functions<std::uint8_t, 4>();
    case 42:
        return row_functions<std::uint16_t, 2>();
    case 44:
        return row_functions<std::uint32_t, 1>();
    default:
        return std::nullopt;
    }
}

RowFunctions checked_row_functions(ByteFilter filter, BandSize size) {
    const auto functions = find_row_functions(size.pixel_bytes, filter.word_bytes);
    FC_ASSERT(functions.has_value(), "filter does not fit the pixels");
    return *functions;
}

} // namespace

ByteFilter filter_for(PlaneFormat format) {
    switch (format) {
    case PlaneFormat::kF32:
        return {Predictor::kLeft, 4};
    case PlaneFormat::kOct2x16:
        return {Predictor::kGradient, 2};
    case PlaneFormat::kU32:
        return {Predictor::kNone, 1};
    case PlaneFormat::kR11G11B10F: // bytewise although its fields are not bytes: 5 % smaller than raw words
    case PlaneFormat::kRg8:
    case PlaneFormat::kRgb8:
        return {Predictor::kGradient, 1};
    }
    return {};
}

std::optional<ByteFilter> filter_from_numbers(PlaneFormat format, std::uint8_t predictor, std::uint8_t word_bytes) {
    if (predictor > static_cast<std::uint8_t>(Predictor::kGradient) ||
        !find_row_functions(bytes_per_pixel(format), word_bytes)) {
        return std::nullopt;
    }
    return ByteFilter{static_cast<Predictor>(predictor), word_bytes};
}

void filter_band(ByteFilter filter, BandSize size, std::span<const std::byte> pixels, std::span<std::byte> filtered) {
    FC_ASSERT(pixels.size() == size.bytes() && filtered.size() == size.bytes(), "band sizes differ");
    const RowFunctions functions = checked_row_functions(filter, size);
    const std::size_t row_bytes = std::size_t{size.width_px} * size.pixel_bytes;
    const std::size_t plane_stride = std::size_t{size.width_px} * size.row_count;
    const std::vector<std::byte> zeros(row_bytes);
    std::vector<std::byte> residual(row_bytes);
    for (std::size_t y = 0; y < size.row_count; ++y) {
        const std::byte* row = pixels.data() + y * row_bytes;
        const bool has_up = filter.predictor == Predictor::kGradient && y > 0;
        if (filter.predictor != Predictor::kNone) {
            functions.predict(row, has_up ? row - row_bytes : zeros.data(), size.width_px, residual.data());
            row = residual.data();
        }
        functions.split(row, size.width_px, filtered.data() + y * size.width_px, plane_stride);
    }
}

void unfilter_band(ByteFilter filter, BandSize size, std::span<const std::byte> filtered, std::span<std::byte> pixels) {
    FC_ASSERT(pixels.size() == size.bytes() && filtered.size() == size.bytes(), "band sizes differ");
    const RowFunctions functions = checked_row_functions(filter, size);
    const std::size_t row_bytes = std::size_t{size.width_px} * size.pixel_bytes;
    const std::size_t plane_stride = std::size_t{size.width_px} * size.row_count;
    const std::vector<std::byte> zeros(row_bytes);
    for (std::size_t y = 0; y < size.row_count; ++y) {
        std::byte* row = pixels.data() + y * row_bytes;
        const std::byte* planes = filtered.data() + y * size.width_px;
        if (filter.predictor == Predictor::kNone) {
            functions.join(planes, plane_stride, size.width_px, row);
            continue;
        }
        const bool has_up = filter.predictor == Predictor::kGradient && y > 0;
        functions.restore(planes, plane_stride, has_up ? row - row_bytes : zeros.data(), size.width_px, row);
    }
}

} // namespace fieldcast::codec
