// SPDX-License-Identifier: Apache-2.0
#include "core/codec/plane_codec.h"

#include "core/codec/byte_filter.h"

#include <algorithm>
#include <memory>
#include <string>
#include <zstd.h>

namespace fieldcast::codec {

namespace {

constexpr std::uint8_t kStripVersion = 1;
constexpr int kZstdLevel = 1;
constexpr std::size_t kKeptScratchBytes = 4U << 20;

/// The first kStripHeaderBytes bytes of a strip; docs/protocol.md has the layout.
struct StripHeader {
    CodecId codec = CodecId::kRaw;
    PlaneFormat format = PlaneFormat::kRgb8;
    ByteFilter filter; ///< RAW: {kNone, 0}
    std::uint32_t width_px = 0;
    RowBand band;
    std::uint32_t body_bytes = 0;
};

void put_u16(std::byte* at, std::uint32_t value) {
    at[0] = static_cast<std::byte>(value);
    at[1] = static_cast<std::byte>(value >> 8);
}

std::uint32_t get_u16(const std::byte* at) {
    return std::to_integer<std::uint32_t>(at[0]) | std::to_integer<std::uint32_t>(at[1]) << 8;
}

void write_header(const StripHeader& header, std::byte* out) {
    out[0] = std::byte{kStripVersion};
    out[1] = static_cast<std::byte>(header.codec);
    out[2] = static_cast<std::byte>(header.format);
    out[3] = static_cast<std::byte>(header.filter.predictor);
    out[4] = static_cast<std::byte>(header.filter.word_bytes);
    out[5] = std::byte{0};
    put_u16(out + 6, header.width_px);
    put_u16(out + 8, header.band.first_row);
    put_u16(out + 10, header.band.row_count);
    put_u16(out + 12, header.body_bytes & 0xFFFF);
    put_u16(out + 14, header.body_bytes >> 16);
}

Decoded<ByteFilter> read_filter(CodecId codec, PlaneFormat format, std::span<const std::byte> strip) {
    const auto predictor = std::to_integer<std::uint8_t>(strip[3]);
    const auto word_bytes = std::to_integer<std::uint8_t>(strip[4]);
    if (codec == CodecId::kRaw) {
        if (predictor != 0 || word_bytes != 0) {
            return decode_error("strip header: RAW has no filter");
        }
        return ByteFilter{Predictor::kNone, 0};
    }
    const auto filter = filter_from_numbers(format, predictor, word_bytes);
    if (!filter) {
        return decode_error("strip header: predictor " + std::to_string(predictor) + " on words of " +
                            std::to_string(word_bytes) + " bytes does not fit the format");
    }
    return *filter;
}

Decoded<StripHeader> read_header(std::span<const std::byte> strip) {
    if (strip.size() < kStripHeaderBytes) {
        return decode_error("strip: " + std::to_string(strip.size()) + " bytes, the header has 16");
    }
    if (strip[0] != std::byte{kStripVersion}) {
        return decode_error("strip header: version " + std::to_string(std::to_integer<int>(strip[0])) + " is not 1");
    }
    const auto codec = codec_from_number(std::to_integer<std::uint8_t>(strip[1]));
    const auto format = static_cast<PlaneFormat>(strip[2]);
    if (!codec || bytes_per_pixel(format) == 0 || strip[5] != std::byte{0}) {
        return decode_error("strip header: unknown codec, format or flags");
    }
    const auto filter = read_filter(*codec, format, strip);
    if (!filter) {
        return tl::unexpected(filter.error());
    }
    StripHeader header{*codec, format, *filter, get_u16(&strip[6]), {get_u16(&strip[8]), get_u16(&strip[10])}, 0};
    header.body_bytes = get_u16(&strip[12]) | get_u16(&strip[14]) << 16;
    if (header.body_bytes != strip.size() - kStripHeaderBytes) {
        return decode_error("strip header: says " + std::to_string(header.body_bytes) + " bytes follow, there are " +
                            std::to_string(strip.size() - kStripHeaderBytes));
    }
    return header;
}

bool is_inside(RowBand band, const Plane& plane) {
    return band.row_count > 0 && band.first_row < plane.height_px &&
           band.row_count <= plane.height_px - band.first_row;
}

BandSize band_size(const Plane& plane, RowBand band) {
    return {plane.width_px, band.row_count, bytes_per_pixel(plane.format)};
}

std::size_t band_offset(const Plane& plane, RowBand band) {
    return std::size_t{band.first_row} * plane.width_px * bytes_per_pixel(plane.format);
}

/// Memory for one strip, reused by the next strip of this thread; large blocks are not kept.
class Scratch {
public:
    explicit Scratch(std::size_t size) {
        if (buffer().size() < size) {
            buffer().resize(size);
        }
        bytes_ = std::span(buffer()).first(size);
    }
    ~Scratch() {
        if (buffer().size() > kKeptScratchBytes) {
            std::vector<std::byte>().swap(buffer());
        }
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    std::span<std::byte> bytes() const { return bytes_; }

private:
    static std::vector<std::byte>& buffer() {
        thread_local std::vector<std::byte> instance;
        return instance;
    }
    std::span<std::byte> bytes_;
};

/// Appends the zstd frame of the filtered pixels to `out`, or returns false if it would be no smaller than they are.
bool append_zstd(ByteFilter filter, BandSize size, std::span<const std::byte> pixels, std::vector<std::byte>& out) {
    thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
    const Scratch filtered(pixels.size());
    filter_band(filter, size, pixels, filtered.bytes());
    const std::size_t start = out.size();
    out.resize(start + ZSTD_compressBound(pixels.size()));
    const std::size_t written = ZSTD_compressCCtx(context.get(), &out[start], out.size() - start,
                                                  filtered.bytes().data(), pixels.size(), kZstdLevel);
    FC_ASSERT(ZSTD_isError(written) == 0, "zstd refused a buffer of its own bound");
    out.resize(start + written);
    return written < pixels.size();
}

Decoded<void> decode_zstd(ByteFilter filter, BandSize size, std::span<const std::byte> body,
                          std::span<std::byte> pixels) {
    thread_local const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
    if (ZSTD_getFrameContentSize(body.data(), body.size()) != pixels.size()) {
        return decode_error("strip: zstd frame does not declare the " + std::to_string(pixels.size()) +
                            " bytes of its rows");
    }
    if (ZSTD_findFrameCompressedSize(body.data(), body.size()) != body.size()) {
        return decode_error("strip: not exactly one zstd frame");
    }
    const Scratch filtered(pixels.size());
    const std::size_t read = ZSTD_decompressDCtx(context.get(), filtered.bytes().data(), pixels.size(), body.data(),
                                                 body.size());
    if (read != pixels.size()) {
        return decode_error(std::string("strip: zstd: ") +
                            (ZSTD_isError(read) != 0 ? ZSTD_getErrorName(read) : "too few bytes"));
    }
    unfilter_band(filter, size, filtered.bytes(), pixels);
    return {};
}

} // namespace

std::optional<CodecId> codec_from_number(std::uint64_t number) {
    switch (static_cast<CodecId>(number)) {
    case CodecId::kRaw:
    case CodecId::kZstdFiltered:
        return number <= 0xFF ? std::optional(static_cast<CodecId>(number)) : std::nullopt;
    }
    return std::nullopt;
}

std::vector<RowBand> strip_bands(std::uint32_t height_px) {
    std::vector<RowBand> bands;
    for (std::uint32_t row = 0; row < height_px; row += kStripRows) {
        bands.push_back({row, std::min(kStripRows, height_px - row)});
    }
    return bands;
}

std::uint64_t max_strip_bytes(PlaneFormat format, std::uint32_t width_px, std::uint32_t row_count) {
    return kStripHeaderBytes + plane_bytes(format, width_px, row_count);
}

std::vector<std::byte> encode_strip(const Plane& plane, RowBand band, CodecId codec) {
    FC_ASSERT(is_inside(band, plane), "rows outside the plane");
    FC_ASSERT(plane.bytes.size() == plane_bytes(plane.format, plane.width_px, plane.height_px), "plane size");
    FC_ASSERT(plane.width_px <= kMaxPlaneSide && plane.height_px <= kMaxPlaneSide, "plane too large for the wire");
    const BandSize size = band_size(plane, band);
    const auto pixels = std::span(plane.bytes).subspan(band_offset(plane, band), size.bytes());
    StripHeader header{codec, plane.format, filter_for(plane.format), plane.width_px, band, 0};
    std::vector<std::byte> strip(kStripHeaderBytes);
    if (codec == CodecId::kRaw || !append_zstd(header.filter, size, pixels, strip)) {
        header.codec = CodecId::kRaw;
        header.filter = {Predictor::kNone, 0};
        strip.resize(kStripHeaderBytes);
        strip.insert(strip.end(), pixels.begin(), pixels.end());
    }
    header.body_bytes = static_cast<std::uint32_t>(strip.size() - kStripHeaderBytes);
    write_header(header, strip.data());
    strip.shrink_to_fit();
    return strip;
}

Decoded<void> decode_strip(std::span<const std::byte> strip, RowBand band, Plane& plane) {
    FC_ASSERT(plane.bytes.size() == plane_bytes(plane.format, plane.width_px, plane.height_px), "plane size");
    if (!is_inside(band, plane)) {
        return decode_error("strip: rows outside the plane");
    }
    const auto header = read_header(strip);
    if (!header) {
        return tl::unexpected(header.error());
    }
    if (header->format != plane.format || header->width_px != plane.width_px || header->band != band) {
        return decode_error("strip header: format, width or rows differ from what was announced");
    }
    const BandSize size = band_size(plane, band);
    const auto pixels = std::span(plane.bytes).subspan(band_offset(plane, band), size.bytes());
    const auto body = strip.subspan(kStripHeaderBytes);
    if (header->codec == CodecId::kZstdFiltered) {
        return decode_zstd(header->filter, size, body, pixels);
    }
    if (body.size() != pixels.size()) {
        return decode_error("strip: " + std::to_string(body.size()) + " raw bytes, its rows have " +
                            std::to_string(pixels.size()));
    }
    std::ranges::copy(body, pixels.begin());
    return {};
}

Decoded<Plane> allocate_plane(PlaneSemantic semantic, PlaneFormat format, std::uint32_t width_px,
                              std::uint32_t height_px) {
    const std::string name = "plane of " + std::to_string(width_px) + "x" + std::to_string(height_px) + " pixels";
    if (bytes_per_pixel(format) == 0) {
        return decode_error("plane: unknown format");
    }
    if (width_px == 0 || height_px == 0 || width_px > kMaxPlaneSide || height_px > kMaxPlaneSide) {
        return decode_error(name + ": sides are 1 to " + std::to_string(kMaxPlaneSide));
    }
    const std::uint64_t size = plane_bytes(format, width_px, height_px);
    if (size > kMaxPlaneBytes) {
        return decode_error(name + ": more than " + std::to_string(kMaxPlaneBytes) + " bytes");
    }
    return Plane{semantic, format, width_px, height_px, std::vector<std::byte>(size)};
}

} // namespace fieldcast::codec
