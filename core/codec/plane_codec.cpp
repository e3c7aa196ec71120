// SPDX-License-Identifier: Apache-2.0
#include "core/codec/plane_codec.h"

#include "core/codec/h264.h"
#include "core/codec/jpeg.h"
#include "core/codec/light_curve.h"
#include "core/codec/zstd_body.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace fieldcast::codec {

namespace {

bool is_inside(RowBand band, const Plane& plane) {
    return band.row_count > 0 && band.first_row < plane.height_px && band.row_count <= plane.height_px - band.first_row;
}

BandSize band_size(const Plane& plane, RowBand band) {
    return {plane.width_px, band.row_count, bytes_per_pixel(plane.format)};
}

/// Bytes of the rows of `band`, of a plane or of its reference.
template <class Bytes> auto rows_of(Bytes& bytes, const Plane& plane, RowBand band) {
    const std::size_t row_bytes = std::size_t{plane.width_px} * bytes_per_pixel(plane.format);
    return std::span(bytes).subspan(band.first_row * row_bytes, band.row_count * row_bytes);
}

bool is_complete(const Plane& plane) {
    return plane.bytes.size() == plane_bytes(plane.format, plane.width_px, plane.height_px);
}

bool is_alike(const Plane* reference, const Plane& plane) {
    return reference == nullptr || (reference->format == plane.format && reference->width_px == plane.width_px &&
                                    reference->height_px == plane.height_px && is_complete(*reference));
}

/// Rows to encode, and the same rows of the reference (empty: none).
struct Rows {
    BandSize size;
    std::span<const std::byte> pixels;
    std::span<const std::byte> reference;
    std::span<const std::byte> base{}; ///< of the base view: its pixels to encode, its H.264 to decode; empty: none
};

/// The filter that needs fewer bits.
ByteFilter choose_filter(PlaneFormat format, const Rows& rows) {
    const ByteFilter spatial = filter_for(format);
    if (rows.reference.empty()) {
        return spatial;
    }
    ByteFilter temporal = spatial;
    temporal.predictor = Predictor::kReference;
    ByteFilter compared = spatial;
    if (spatial.predictor == Predictor::kNone) { // zstd finds repetitions, which then cost no bits
        compared.predictor = Predictor::kLeft;
    }
    const bool is_temporal_cheaper = filter_cost(temporal, rows.size, rows.pixels, rows.reference) <
                                     filter_cost(compared, rows.size, rows.pixels, {});
    return is_temporal_cheaper ? temporal : spatial;
}

RgbSize rgb_size(BandSize size) {
    return {size.width_px, size.row_count};
}

/// Buffer for the picture samples of light; kept per thread.
std::span<std::byte> sample_scratch(BandSize size) {
    thread_local std::vector<std::byte> samples;
    samples.resize(rgb_size(size).bytes());
    return samples;
}

/// False, with `strip` unchanged, if the result is not smaller than the pixels.
bool append_jpeg(PlaneFormat format, const Rows& rows, const StripOptions& options, std::vector<std::byte>& strip) {
    JpegQuality quality = kViewQuality;
    std::span<const std::byte> samples = rows.pixels;
    std::vector<std::byte> body;
    if (format == PlaneFormat::kR11G11B10F) {
        quality = kLightQuality;
        const LightCurve curve = light_curve_for(rows.pixels, options.exposure);
        const auto scratch = sample_scratch(rows.size);
        samples_from_light(curve, rows.pixels, scratch);
        samples = scratch;
        std::ranges::copy(encode_curve(curve), std::back_inserter(body));
    }
    quality.quality = options.encoding.quality;
    std::ranges::copy(encode_jpeg(samples, rgb_size(rows.size), quality), std::back_inserter(body));
    if (body.size() >= rows.pixels.size()) {
        return false;
    }
    strip.insert(strip.end(), body.begin(), body.end());
    return true;
}

/// False, with `strip` unchanged, if the result is not smaller than the pixels.
bool append_h264(const Rows& rows, std::uint8_t quality, std::vector<std::byte>& strip) {
    const RgbSize size = rgb_size(rows.size);
    if (size.width_px > kMaxH264Side || size.row_count > kMaxH264Side) {
        return false;
    }
    const std::vector<std::byte> body = rows.base.empty() ? encode_h264(rows.pixels, size, quality)
                                                          : encode_h264_from(rows.base, rows.pixels, size, quality);
    if (body.size() >= rows.pixels.size()) {
        return false;
    }
    strip.insert(strip.end(), body.begin(), body.end());
    return true;
}

/// Body of the strip that predicts the strip of `header`; empty if that one stands alone.
Decoded<std::span<const std::byte>> base_body(const StripHeader& header, std::span<const std::byte> base) {
    if (!header.is_predicted) {
        return std::span<const std::byte>();
    }
    const auto found = read_header(base);
    if (!found || found->coding != StripCoding::kH264 || found->is_predicted || found->width_px != header.width_px ||
        found->band != header.band) {
        return decode_error("strip: predicted from a base view that has no such strip");
    }
    return base.subspan(kStripHeaderBytes);
}

Decoded<void> decode_jpeg_body(PlaneFormat format, BandSize size, std::span<const std::byte> body,
                               std::span<std::byte> pixels) {
    if (format != PlaneFormat::kR11G11B10F) {
        return decode_jpeg(body, rgb_size(size), pixels);
    }
    const auto curve = decode_curve(body);
    if (!curve) {
        return tl::unexpected(curve.error());
    }
    const auto samples = sample_scratch(size);
    if (const auto result = decode_jpeg(body.subspan(kLightCurveBytes), rgb_size(size), samples); !result) {
        return result;
    }
    light_from_samples(*curve, samples, pixels);
    return {};
}

/// False, with `strip` unchanged, if the result is not smaller than the pixels.
bool append_filtered(const Rows& rows, const StripOptions& options, StripHeader& header, std::vector<std::byte>& strip) {
    header.filter = options.filter.value_or(choose_filter(header.format, rows));
    const bool is_temporal = header.filter.predictor == Predictor::kReference;
    const bool is_smaller = append_zstd(header.filter, rows.size, rows.pixels,
                                        is_temporal ? rows.reference : std::span<const std::byte>(), strip);
    if (!is_smaller) {
        strip.resize(kStripHeaderBytes);
    }
    return is_smaller;
}

/// Writes the strip's coding to `header`. False, with `strip` unchanged, if the body is not smaller than the pixels.
bool append_encoded(const Rows& rows, const StripOptions& options, StripHeader& header, std::vector<std::byte>& strip) {
    switch (options.encoding.codec) {
    case Codec::kRaw:
        return false;
    case Codec::kZstdFiltered:
        header.coding = StripCoding::kZstdFiltered;
        return append_filtered(rows, options, header, strip);
    case Codec::kJpeg:
        header.coding = StripCoding::kJpeg;
        return append_jpeg(header.format, rows, options, strip);
    case Codec::kH264:
        header.coding = StripCoding::kH264;
        header.is_predicted = !rows.base.empty();
        return append_h264(rows, options.encoding.quality, strip);
    }
    return false;
}

/// Appends the body to `strip`, which consists of an unwritten header, and writes the strip's coding to `header`.
void append_body(const Rows& rows, const StripOptions& options, StripHeader& header, std::vector<std::byte>& strip) {
    if (!rows.reference.empty() && std::ranges::equal(rows.pixels, rows.reference)) {
        header.coding = StripCoding::kRepeat;
    } else if (!append_encoded(rows, options, header, strip)) {
        header.coding = StripCoding::kRaw;
        strip.insert(strip.end(), rows.pixels.begin(), rows.pixels.end());
    }
}

Decoded<void> decode_body(const StripHeader& header, std::span<const std::byte> body, const Rows& rows,
                          std::span<std::byte> pixels) {
    const bool is_temporal = header.filter.predictor == Predictor::kReference;
    switch (header.coding) {
    case StripCoding::kZstdFiltered:
        return decode_zstd(header.filter, rows.size, body, is_temporal ? rows.reference : std::span<const std::byte>(),
                           pixels);
    case StripCoding::kJpeg:
        return decode_jpeg_body(header.format, rows.size, body, pixels);
    case StripCoding::kH264:
        return decode_h264(rows.base, body, rgb_size(rows.size), pixels);
    case StripCoding::kRepeat:
        if (!body.empty()) {
            return decode_error("strip: a repetition has no bytes");
        }
        std::ranges::copy(rows.reference, pixels.begin());
        return {};
    case StripCoding::kRaw:
        break;
    }
    if (body.size() != pixels.size()) {
        return decode_error("strip: " + std::to_string(body.size()) + " raw bytes, its rows have " +
                            std::to_string(pixels.size()));
    }
    std::ranges::copy(body, pixels.begin());
    return {};
}

} // namespace

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

std::vector<std::byte> encode_strip(const Plane& plane, RowBand band, const StripOptions& options) {
    FC_ASSERT(is_inside(band, plane), "rows outside the plane");
    FC_ASSERT(is_complete(plane), "plane size");
    FC_ASSERT(plane.width_px <= kMaxPlaneSide && plane.height_px <= kMaxPlaneSide, "plane too large for the wire");
    FC_ASSERT(is_alike(options.reference, plane), "reference of another size or format");
    FC_ASSERT(is_alike(options.base, plane), "base view of another size or format");
    FC_ASSERT(carries(options.encoding.codec, plane.format), "codec does not fit the format");
    Rows rows{band_size(plane, band), rows_of(plane.bytes, plane, band), {}};
    if (options.reference != nullptr) {
        rows.reference = rows_of(options.reference->bytes, plane, band);
    }
    if (options.base != nullptr) {
        rows.base = rows_of(options.base->bytes, plane, band);
    }
    StripHeader header{.format = plane.format, .width_px = plane.width_px, .band = band};
    std::vector<std::byte> strip(kStripHeaderBytes);
    append_body(rows, options, header, strip);
    write_header(header, strip);
    strip.shrink_to_fit();
    return strip;
}

bool needs_reference(std::span<const std::byte> strip) {
    const auto header = read_header(strip);
    FC_ASSERT(header.has_value(), "not a strip");
    return header->needs_reference();
}

bool can_be_base(std::span<const std::byte> strip) {
    const auto header = read_header(strip);
    FC_ASSERT(header.has_value(), "not a strip");
    return header->coding == StripCoding::kH264 && !header->is_predicted;
}

Decoded<void> decode_strip(std::span<const std::byte> strip, RowBand band, const Announced& announced, Plane& plane) {
    const Plane* const reference = announced.reference;
    FC_ASSERT(is_complete(plane) && is_alike(reference, plane), "plane size");
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
    const std::optional<Codec> codec = codec_of(header->coding);
    if (codec && is_lossy(*codec) && (announced.codec != *codec || !carries(*codec, plane.format))) {
        return decode_error("strip: " + std::string(word_of(*codec)) + " in a plane of another codec");
    }
    if (header->needs_reference() && reference == nullptr) {
        return decode_error("strip: refers to another frame, but its frame has no reference");
    }
    Rows rows{band_size(plane, band), {}, {}};
    if (reference != nullptr) {
        rows.reference = rows_of(reference->bytes, plane, band);
    }
    const auto base = base_body(*header, announced.base);
    if (!base) {
        return tl::unexpected(base.error());
    }
    rows.base = *base;
    return decode_body(*header, strip.subspan(kStripHeaderBytes), rows, rows_of(plane.bytes, plane, band));
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
