// SPDX-License-Identifier: Apache-2.0
// The layout of OpenEXR files: "OpenEXR File Layout", Academy Software Foundation (openexr.com), sections "Magic
// Number and Version Field", "Header" and "Attribute Types". All numbers are little-endian.
#include "core/image/light_image_header.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace fieldcast::image {

namespace {

constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";
constexpr std::size_t kMaxNameBytes = 255;
constexpr std::size_t kMaxChannels = 32;
constexpr std::uint64_t kMaxLinesPerChunk = 256; ///< of DWAB compression
constexpr std::uint64_t kChunkEntryBytes = 8;    ///< in the chunk offset table
constexpr std::uint32_t kDeepFlag = 0x800;
constexpr std::uint32_t kManyPartsFlag = 0x1000;

struct Size {
    std::uint64_t width_px = 0;
    std::uint64_t height_px = 0;
};

/// One attribute of a header.
struct Attribute {
    std::string_view name;
    std::string_view value;
};

std::uint32_t little32(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    }
    return value;
}

struct TypeSize {
    std::string_view type;
    std::size_t bytes;
};

/// "Attribute Types". OpenEXR reads as many bytes as the type has, and ignores the size before the value.
constexpr std::array kTypeSizes{
    TypeSize{"box2f", 16},         TypeSize{"box2i", 16},   TypeSize{"chromaticities", 32}, TypeSize{"compression", 1},
    TypeSize{"deepImageState", 1}, TypeSize{"double", 8},   TypeSize{"envmap", 1},          TypeSize{"float", 4},
    TypeSize{"int", 4},            TypeSize{"keycode", 28}, TypeSize{"lineOrder", 1},       TypeSize{"m33d", 72},
    TypeSize{"m33f", 36},          TypeSize{"m44d", 128},   TypeSize{"m44f", 64},           TypeSize{"rational", 8},
    TypeSize{"tiledesc", 9},       TypeSize{"timecode", 8}, TypeSize{"v2d", 16},            TypeSize{"v2f", 8},
    TypeSize{"v2i", 8},            TypeSize{"v3d", 24},     TypeSize{"v3f", 12},            TypeSize{"v3i", 12},
};

/// Removes one channel: its name and 16 bytes. False at the end of the list.
bool skip_channel(std::string_view& list) {
    const std::size_t end = list.find('\0');
    if (end == std::string_view::npos || end == 0) {
        return false;
    }
    list.remove_prefix(std::min(end + 17, list.size()));
    return true;
}

/// The channel list must end with an empty name, exactly at the end of its value.
bool is_channel_list(std::string_view value) {
    while (skip_channel(value)) {
    }
    return value.size() == 1 && value.front() == '\0';
}

/// A width, a height, and four bytes for each pixel.
bool is_preview(std::string_view value) {
    return value.size() >= 8 && std::uint64_t{little32(value)} * little32(value.substr(4)) == (value.size() - 8) / 4 &&
           value.size() % 4 == 0;
}

/// Strings, each after its size.
bool is_string_list(std::string_view value) {
    while (value.size() >= 4 && little32(value) <= value.size() - 4) {
        value.remove_prefix(4 + little32(value));
    }
    return value.empty();
}

/// Whether the declared size of a value is the one that OpenEXR derives from its type. Otherwise OpenEXR would read
/// other bytes as the next attribute, and allocate the sizes found there.
bool has_size_of_type(std::string_view type, std::string_view value) {
    if (type == "chlist") {
        return is_channel_list(value);
    }
    if (type == "preview") {
        return is_preview(value);
    }
    if (type == "stringvector") {
        return is_string_list(value);
    }
    const auto* const found = std::ranges::find(kTypeSizes, type, &TypeSize::type);
    return found == kTypeSizes.end() || found->bytes == value.size();
}

/// Reads the headers of an OpenEXR file, one per part.
class ExrReader {
public:
    ExrReader(std::string_view bytes, std::uint64_t file_bytes, std::uint64_t max_pixels)
        : bytes_(bytes), file_bytes_(file_bytes), max_pixels_(max_pixels) {}

    Decoded<void> read() {
        bytes_.remove_prefix(kExrMagic.size());
        if (bytes_.size() < 4) {
            return decode_error("truncated OpenEXR header");
        }
        const std::uint32_t version = little32(bytes_);
        bytes_.remove_prefix(4);
        if ((version & kDeepFlag) != 0) {
            return decode_error("deep images are not supported");
        }
        do {
            if (auto result = read_part(); !result) {
                return result;
            }
        } while ((version & kManyPartsFlag) != 0 && !bytes_.empty() && bytes_.front() != '\0');
        return {};
    }

private:
    Decoded<void> read_part() {
        Size image;
        Size tile{1, 1};
        bool is_tiled = false;
        for (;;) {
            const auto attribute = next();
            if (!attribute) {
                return tl::unexpected(attribute.error());
            }
            if (attribute->name.empty()) {
                return check(image, is_tiled, tile);
            }
            const std::string_view value = attribute->value;
            if (attribute->name == "dataWindow") {
                image = window_size(value);
            } else if (attribute->name == "tiles") {
                is_tiled = true;
                tile = value.size() < 8 ? Size{} : Size{little32(value), little32(value.substr(4))};
            } else if (attribute->name == "channels" && !has_few_channels(value)) {
                return decode_error("more than " + std::to_string(kMaxChannels) + " channels");
            } else if (attribute->name == "chunkCount" && (value.size() < 4 || !has_room(little32(value)))) {
                return decode_error("more chunks than the file has room for");
            }
        }
    }

    /// Name and value of the next attribute; an empty name: the header ends.
    Decoded<Attribute> next() {
        const auto name = text();
        if (!name || name->empty()) {
            return name ? Decoded<Attribute>(Attribute{}) : tl::unexpected(name.error());
        }
        const auto type = text();
        if (!type) {
            return tl::unexpected(type.error());
        }
        if (bytes_.size() < 4 || little32(bytes_) > bytes_.size() - 4) {
            return decode_error("an attribute of the OpenEXR header is larger than the header may be");
        }
        const Attribute attribute{*name, bytes_.substr(4, little32(bytes_))};
        if (*type == "idmanifest" || !has_size_of_type(*type, attribute.value)) {
            return decode_error("an attribute of the OpenEXR header has a size that does not match its type");
        }
        bytes_.remove_prefix(4 + attribute.value.size());
        return attribute;
    }

    Decoded<std::string_view> text() {
        const std::size_t end = bytes_.find('\0');
        if (end == std::string_view::npos || end > kMaxNameBytes) {
            return decode_error("truncated OpenEXR header, or one of more than " +
                                std::to_string(kLightHeaderBytes) + " bytes");
        }
        const std::string_view found = bytes_.substr(0, end);
        bytes_.remove_prefix(end + 1);
        return found;
    }

    /// Size of a window, given by two corners that both lie inside; 0 if there is no such window.
    static Size window_size(std::string_view corners) {
        if (corners.size() < 16) {
            return {};
        }
        const auto side = [&](std::size_t axis) -> std::uint64_t {
            const auto first = std::int64_t{static_cast<std::int32_t>(little32(corners.substr(4 * axis)))};
            const auto last = std::int64_t{static_cast<std::int32_t>(little32(corners.substr(8 + 4 * axis)))};
            return last < first ? 0 : static_cast<std::uint64_t>(last - first + 1);
        };
        return {side(0), side(1)};
    }

    /// Channels have a name and 16 bytes each.
    static bool has_few_channels(std::string_view list) {
        std::size_t count = 0;
        while (skip_channel(list)) {
            ++count;
        }
        return count <= kMaxChannels;
    }

    bool has_room(std::uint64_t chunks) const { return chunks <= file_bytes_ / kChunkEntryBytes; }

    bool is_size(const Size& size) const {
        return size.width_px > 0 && size.height_px > 0 && size.width_px <= max_pixels_ &&
               size.height_px <= max_pixels_ / size.width_px;
    }

    Decoded<void> check(const Size& image, bool is_tiled, const Size& tile) const {
        const std::string text = std::to_string(image.width_px) + "x" + std::to_string(image.height_px);
        if (!is_size(image)) {
            return decode_error("image of " + text + " pixels, at most " + std::to_string(max_pixels_) +
                                " pixels are accepted");
        }
        if (is_tiled && !is_size(tile)) {
            return decode_error("tiles without a size, or larger than an image may be");
        }
        const std::uint64_t chunks = is_tiled ? (image.width_px / tile.width_px) * (image.height_px / tile.height_px)
                                              : image.height_px / kMaxLinesPerChunk;
        return has_room(chunks) ? Decoded<void>() : decode_error("image of " + text + " pixels in so small a file");
    }

    std::string_view bytes_; ///< the unread rest
    std::uint64_t file_bytes_;
    std::uint64_t max_pixels_;
};

} // namespace

Decoded<LightFormat> read_light_image_header(std::span<const std::byte> beginning, std::uint64_t file_bytes,
                                             std::uint64_t max_pixels) {
    const std::string_view bytes(reinterpret_cast<const char*>(beginning.data()), beginning.size());
    if (bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE")) {
        return LightFormat::kRadiance;
    }
    if (!bytes.starts_with(kExrMagic)) {
        return decode_error("expected a .hdr or .exr image");
    }
    return ExrReader(bytes, file_bytes, max_pixels).read().map([] { return LightFormat::kOpenExr; });
}

} // namespace fieldcast::image
