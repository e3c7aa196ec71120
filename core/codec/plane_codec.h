// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/codec/encoding.h"
#include "core/codec/strip.h"
#include "core/lightfield/plane.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fieldcast::codec {

/// Rows per strip that our encoder makes (the last strip of a plane has fewer). Decoders take any number of rows.
inline constexpr std::uint32_t kStripRows = 120;

/// The bands of `kStripRows` rows that cover a plane of that height, from the top.
std::vector<RowBand> strip_bands(std::uint32_t height_px);

/// Largest size of an encoded strip: the encoder falls back to RAW where a codec would enlarge it.
std::uint64_t max_strip_bytes(PlaneFormat format, std::uint32_t width_px, std::uint32_t row_count);

struct StripOptions {
    Encoding encoding{}; ///< must fit the plane's format
    /// The plane that the receiver has from an earlier frame, of the same format and size, as it was before it was
    /// encoded; null: the strip refers to nothing.
    const Plane* reference = nullptr;
    /// For kH264: the plane of the base view, of the same format and size, whose strip of the same rows stands alone;
    /// null: this strip stands alone.
    const Plane* base = nullptr;
    float exposure = 1.0F; ///< of the frame: multiplies light for display; lossy codecs distribute bits by it
    std::optional<ByteFilter> filter{}; ///< for tests and benchmarks; otherwise the cheaper one
};

/// Encodes the rows of `band`, which must lie inside `plane`. Strips are independent of each other. With a reference,
/// equal rows become a repetition, and lossless codecs send differences from it where those need fewer bits.
/// Thread-safe: strips of one plane may be encoded in parallel. Same input, same bytes (for one version of zstd).
std::vector<std::byte> encode_strip(const Plane& plane, RowBand band, const StripOptions& options);

/// Whether a strip that we encoded needs the reference.
bool needs_reference(std::span<const std::byte> strip);

/// Whether others may be predicted from a strip that we encoded: it is H.264 and stands alone.
bool can_be_base(std::span<const std::byte> strip);

/// Properties of a plane's strips that a receiver knows in advance.
struct Announced {
    Codec codec = Codec::kZstdFiltered; ///< strips may be of this kind, or lossless
    const Plane* reference = nullptr;       ///< of the same format and size; null: strips that need one are refused
    std::span<const std::byte> base{};      ///< the strip of the same rows of the base view; empty: none
};

/// Decodes one strip into its rows of `plane`, whose format, size and `bytes` the caller has set. The strip must say
/// exactly that format, that width and that `band`. On failure those rows are undefined, others untouched.
/// Thread-safe for different bands. Scratch memory: at most twice the band's pixels, kept per thread.
Decoded<void> decode_strip(std::span<const std::byte> strip, RowBand band, const Announced& announced, Plane& plane);

/// A plane of the given size with zeroed pixels; fails without allocating beyond kMaxPlaneSide or kMaxPlaneBytes, for
/// empty planes and for unknown formats.
Decoded<Plane> allocate_plane(PlaneSemantic semantic, PlaneFormat format, std::uint32_t width_px,
                              std::uint32_t height_px);

} // namespace fieldcast::codec
