// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Content of a stream: delivery modes, planes, formats, codecs, denoisers. Each value has one row, and everything else
// derives from the rows: wire checks, words of flags and files, negotiation, adaptation, recordings, metrics, load
// scenarios and benchmarks. docs/extending.md says how to add a value.
namespace fieldcast {

/// Meaning of a plane. Values are on the wire: never renumber.
enum class PlaneSemantic : std::uint8_t {
    kDiffuse = 1,  ///< demodulated diffuse illumination, linear Rec. 709, unexposed
    kSpecular = 2, ///< demodulated specular illumination
    kDepth = 3,    ///< view depth (−Z), metres; infinity where nothing was hit
    kNormal = 4,   ///< shading normal, world space, octahedral
    kId = 5,       ///< instance << 12 | material; 0xFFFFFFFF where nothing was hit
    kMaterial = 6, ///< roughness, metallic
    kColour = 7,   ///< display-referred sRGB of a finished view, or of the source with its guard band
    kInverseDepth = 20,         ///< 1 / view depth in units of FrameHeader::inverse_depth_unit; 0 where nothing was hit
    kResidualColour = 21,       ///< as kColour, of ResidualLayer
    kResidualInverseDepth = 22, ///< as kInverseDepth, of ResidualLayer
    kTotalLight = 30,           ///< illumination that gives the same image when used as both kDiffuse and kSpecular
};

/// How one pixel is stored, little-endian. Values are on the wire: never renumber.
enum class PlaneFormat : std::uint8_t {
    kR11G11B10F = 1, ///< u32: unsigned floats with 6, 6 and 5 mantissa bits, red in the low bits
    kF32 = 2,        ///< IEEE float
    kOct2x16 = 3,    ///< u32: octahedral x in the low, y in the high 16 bits, snorm
    kU32 = 4,
    kRg8 = 5,  ///< 2 bytes, unorm
    kRgb8 = 6, ///< 3 bytes, sRGB
    kR16 = 20,   ///< u16
    kOct2x8 = 30, ///< u16: octahedral x in the low, y in the high 8 bits, snorm
};

/// Coding of a plane's strips. Values are on the wire: never renumber.
enum class Codec : std::uint8_t {
    kRaw = 1,          ///< pixels as they are
    kZstdFiltered = 2, ///< predictor per format, byte planes, zstd level 1
    kJpeg = 3,         ///< baseline JPEG without subsampling
    kH264 = 4,         ///< H.264, 4:2:0; views are predicted from one view of the same frame
};

/// Content of a stream, which decides where the views are made. Values are on the wire: never renumber.
enum class DeliveryMode : std::uint8_t {
    kViews = 1, ///< finished views
    kScene = 2, ///< planes of the source; the client has the scene and makes its own views
    kWarp = 3,  ///< colour and depth of the source; the client makes its own views without the scene
};

/// The planes that a client of mode kScene wants. Values are on the wire: never renumber.
enum class PlaneSet : std::uint8_t {
    kIllumination = 1,
    kWithGBuffer = 2,
    kTotalLight = 30, ///< illumination in one plane instead of two
};

/// Planes that a client of mode kWarp wants besides that mode's own. Values are on the wire: never renumber.
enum class WarpPlane : std::uint8_t { kResidual = 1, kNormal = 2, kId = 3 };

/// Filter that smooths the light of pixels. Values are on the wire: never renumber.
enum class Denoiser : std::uint8_t {
    kNone = 1,
    kSvgf = 2,     ///< with its paper's parameters
    kSvgfPlus = 3, ///< two histories, sharper and faster (docs/lightfield.md)
    kBmfr = 4,     ///< blockwise fits, with its paper's parameters
};

/// Which images are denoised: the green and the red route in figure 1 of the light field paper (docs/lightfield.md).
/// Values are on the wire: never renumber.
enum class DenoisedImages : std::uint8_t {
    kSource = 1, ///< the source, whose denoised light is then reprojected
    kViews = 2,  ///< every view, after the source's noisy light was reprojected and holes were filled
};

/// Side that makes the views which a client shows.
enum class ViewMaker : std::uint8_t { kServer, kClient };

struct FormatRow {
    std::string_view word;
    std::uint32_t bytes_per_pixel = 0;
};

struct PlaneRow {
    std::string_view word;
    PlaneFormat format{};                       ///< of source frames, and on the wire unless another was agreed on
    std::optional<PlaneFormat> coarse_format{}; ///< the alternative that clients may request
};

struct CodecRow {
    std::string_view word;
    bool is_lossy = false;              ///< has a quality, 1 to kMaxQuality
    bool predicts_views = false;        ///< strips of views may refer to another view of the same frame
    std::span<const PlaneFormat> only{}; ///< formats that it carries; empty: every format
};

struct ModeRow {
    std::string_view word;
    ViewMaker maker = ViewMaker::kServer;
    bool needs_scene = false;                 ///< the client has to hold the scene
    bool needs_one_source = false;            ///< only of channels that render one source image
    std::span<const PlaneSemantic> planes{}; ///< present in each of its frames; planes_of() adds the others
};

/// Row of a PlaneSet or a WarpPlane.
struct PlaneListRow {
    std::string_view word;
    std::span<const PlaneSemantic> planes{};
};

/// Row of an enumeration of which flags and files need only the words.
struct WordRow {
    std::string_view word;
};

namespace vocabulary {

using enum PlaneSemantic;

inline constexpr std::array kColourOnly{PlaneFormat::kRgb8};
inline constexpr std::array kColourAndLight{PlaneFormat::kRgb8, PlaneFormat::kR11G11B10F};
inline constexpr std::array kOfViews{kColour};
inline constexpr std::array kOfWarp{kColour, kInverseDepth};
inline constexpr std::array kOfIllumination{kDiffuse, kSpecular};
inline constexpr std::array kOfGBuffer{kDiffuse, kSpecular, kDepth, kNormal, kId, kMaterial};
inline constexpr std::array kOfTotalLight{kTotalLight};
inline constexpr std::array kOfResidual{kResidualColour, kResidualInverseDepth};
inline constexpr std::array kOfNormal{kNormal};
inline constexpr std::array kOfId{kId};

} // namespace vocabulary

// The rows. A value without a row does not compile (-Wswitch); a number that is not a value gets a row without a word.

constexpr FormatRow row_of(PlaneFormat format) {
    switch (format) {
    case PlaneFormat::kR11G11B10F:
        return {.word = "r11g11b10f", .bytes_per_pixel = 4};
    case PlaneFormat::kF32:
        return {.word = "f32", .bytes_per_pixel = 4};
    case PlaneFormat::kOct2x16:
        return {.word = "oct2x16", .bytes_per_pixel = 4};
    case PlaneFormat::kU32:
        return {.word = "u32", .bytes_per_pixel = 4};
    case PlaneFormat::kRg8:
        return {.word = "rg8", .bytes_per_pixel = 2};
    case PlaneFormat::kRgb8:
        return {.word = "rgb8", .bytes_per_pixel = 3};
    case PlaneFormat::kR16:
        return {.word = "r16", .bytes_per_pixel = 2};
    case PlaneFormat::kOct2x8:
        return {.word = "oct2x8", .bytes_per_pixel = 2};
    }
    return {};
}

constexpr PlaneRow row_of(PlaneSemantic semantic) {
    switch (semantic) {
    case PlaneSemantic::kDiffuse:
        return {.word = "diffuse", .format = PlaneFormat::kR11G11B10F};
    case PlaneSemantic::kSpecular:
        return {.word = "specular", .format = PlaneFormat::kR11G11B10F};
    case PlaneSemantic::kDepth:
        return {.word = "depth", .format = PlaneFormat::kF32};
    case PlaneSemantic::kNormal:
        return {.word = "normal", .format = PlaneFormat::kOct2x16, .coarse_format = PlaneFormat::kOct2x8};
    case PlaneSemantic::kId:
        return {.word = "id", .format = PlaneFormat::kU32};
    case PlaneSemantic::kMaterial:
        return {.word = "material", .format = PlaneFormat::kRg8};
    case PlaneSemantic::kColour:
        return {.word = "colour", .format = PlaneFormat::kRgb8};
    case PlaneSemantic::kInverseDepth:
        return {.word = "inverse_depth", .format = PlaneFormat::kR16};
    case PlaneSemantic::kResidualColour:
        return {.word = "residual_colour", .format = PlaneFormat::kRgb8};
    case PlaneSemantic::kResidualInverseDepth:
        return {.word = "residual_inverse_depth", .format = PlaneFormat::kR16};
    case PlaneSemantic::kTotalLight:
        return {.word = "total_light", .format = PlaneFormat::kR11G11B10F};
    }
    return {};
}

constexpr CodecRow row_of(Codec codec) {
    switch (codec) {
    case Codec::kRaw:
        return {.word = "raw"};
    case Codec::kZstdFiltered:
        return {.word = "zstd"};
    case Codec::kJpeg:
        return {.word = "jpeg", .is_lossy = true, .only = vocabulary::kColourAndLight};
    case Codec::kH264:
        return {.word = "h264", .is_lossy = true, .predicts_views = true, .only = vocabulary::kColourOnly};
    }
    return {};
}

constexpr ModeRow row_of(DeliveryMode mode) {
    switch (mode) {
    case DeliveryMode::kViews:
        return {.word = "views", .planes = vocabulary::kOfViews};
    case DeliveryMode::kScene:
        return {.word = "scene", .maker = ViewMaker::kClient, .needs_scene = true};
    case DeliveryMode::kWarp:
        return {.word = "warp",
                .maker = ViewMaker::kClient,
                .needs_one_source = true,
                .planes = vocabulary::kOfWarp};
    }
    return {};
}

constexpr PlaneListRow row_of(PlaneSet set) {
    switch (set) {
    case PlaneSet::kIllumination:
        return {.word = "illumination", .planes = vocabulary::kOfIllumination};
    case PlaneSet::kWithGBuffer:
        return {.word = "g-buffer", .planes = vocabulary::kOfGBuffer};
    case PlaneSet::kTotalLight:
        return {.word = "total-light", .planes = vocabulary::kOfTotalLight};
    }
    return {};
}

constexpr PlaneListRow row_of(WarpPlane plane) {
    switch (plane) {
    case WarpPlane::kResidual:
        return {.word = "residual", .planes = vocabulary::kOfResidual};
    case WarpPlane::kNormal:
        return {.word = "normal", .planes = vocabulary::kOfNormal};
    case WarpPlane::kId:
        return {.word = "id", .planes = vocabulary::kOfId};
    }
    return {};
}

constexpr WordRow row_of(Denoiser denoiser) {
    switch (denoiser) {
    case Denoiser::kNone:
        return {.word = "none"};
    case Denoiser::kSvgf:
        return {.word = "svgf"};
    case Denoiser::kSvgfPlus:
        return {.word = "svgf+"};
    case Denoiser::kBmfr:
        return {.word = "bmfr"};
    }
    return {};
}

constexpr WordRow row_of(DenoisedImages images) {
    switch (images) {
    case DenoisedImages::kSource:
        return {.word = "source"};
    case DenoisedImages::kViews:
        return {.word = "views"};
    }
    return {};
}

/// The value with that number, or nothing.
template <class Enum> constexpr std::optional<Enum> from_number(std::uint64_t number) {
    const auto value = static_cast<Enum>(number & 0xFFU);
    return number <= 0xFFU && !row_of(value).word.empty() ? std::optional(value) : std::nullopt;
}

/// All values of an enumeration, by their numbers.
template <class Enum>
inline constexpr auto kAll = [] {
    constexpr std::size_t kCount = [] {
        std::size_t count = 0;
        for (std::uint64_t number = 0; number <= 0xFFU; ++number) {
            count += from_number<Enum>(number) ? 1U : 0U;
        }
        return count;
    }();
    std::array<Enum, kCount> all{};
    std::size_t count = 0;
    for (std::uint64_t number = 0; number <= 0xFFU; ++number) {
        if (const auto value = from_number<Enum>(number)) {
            all[count++] = *value;
        }
    }
    return all;
}();

template <class Enum> constexpr std::string_view word_of(Enum value) {
    return row_of(value).word;
}

/// The value with that word, or nothing.
template <class Enum> constexpr std::optional<Enum> from_word(std::string_view word) {
    for (const Enum value : kAll<Enum>) {
        if (word_of(value) == word) {
            return value;
        }
    }
    return std::nullopt;
}

/// The words of the values for messages: "views, scene or warp".
template <class Enum> std::string alternatives(std::span<const Enum> values = kAll<Enum>) {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += i == 0 ? "" : i + 1 == values.size() ? " or " : ", ";
        text += word_of(values[i]);
    }
    return text;
}

/// All words of an enumeration.
template <class Enum> std::vector<std::string> words() {
    std::vector<std::string> all;
    for (const Enum value : kAll<Enum>) {
        all.emplace_back(word_of(value));
    }
    return all;
}

inline constexpr std::uint8_t kMaxQuality = 100; ///< of lossy codecs, from 1

constexpr bool is_lossy(Codec codec) {
    return row_of(codec).is_lossy;
}

/// Whether that codec can encode planes of that format.
constexpr bool carries(Codec codec, PlaneFormat format) {
    const std::span<const PlaneFormat> only = row_of(codec).only;
    bool is_found = only.empty();
    for (const PlaneFormat one : only) {
        is_found = is_found || one == format;
    }
    return is_found;
}

/// Format of planes with that semantic in source frames, and on the wire unless another one was agreed on.
constexpr PlaneFormat usual_format(PlaneSemantic semantic) {
    return row_of(semantic).format;
}

/// Whether planes with that semantic may be sent in that format.
constexpr bool may_have_format(PlaneSemantic semantic, PlaneFormat format) {
    const PlaneRow row = row_of(semantic);
    return format == row.format || format == row.coarse_format;
}

/// Whether some lossy codec carries planes with that semantic. Clients choose codecs for these; all others are
/// lossless.
constexpr bool is_picture(PlaneSemantic semantic) {
    for (const Codec codec : kAll<Codec>) {
        if (is_lossy(codec) && carries(codec, usual_format(semantic))) {
            return true;
        }
    }
    return false;
}

constexpr bool is_made_by_client(DeliveryMode mode) {
    return row_of(mode).maker == ViewMaker::kClient;
}

/// Planes of a frame of that mode, in the order in which they are sent. `set` matters in modes that need the scene.
/// `extra` matters in modes whose own planes let a client make views without it.
std::vector<PlaneSemantic> planes_of(DeliveryMode mode, PlaneSet set, std::span<const WarpPlane> extra);

} // namespace fieldcast
