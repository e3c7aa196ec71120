// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_header.h"

#include <string_view>

namespace fieldcast::image {

namespace {

/// Bytes as numbers; positions outside read as 0, which no valid size contains.
class ByteView {
public:
    explicit ByteView(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::size_t size() const { return bytes_.size(); }
    std::uint32_t at(std::size_t position) const {
        return position < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[position]) : 0;
    }
    std::uint32_t big16(std::size_t position) const { return at(position) << 8 | at(position + 1); }
    std::uint32_t big32(std::size_t position) const { return big16(position) << 16 | big16(position + 2); }
    std::uint32_t little16(std::size_t position) const { return at(position) | at(position + 1) << 8; }
    std::uint32_t little24(std::size_t position) const { return little16(position) | at(position + 2) << 16; }
    bool has(std::size_t position, std::string_view text) const {
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (position + i >= size() || at(position + i) != static_cast<unsigned char>(text[i])) {
                return false;
            }
        }
        return true;
    }

private:
    std::span<const std::byte> bytes_;
};

/// Whether the chunks of a PNG follow each other up to IEND. OpenImageIO 2.4 leaks memory when the bytes end early.
bool is_complete_png(const ByteView& bytes) {
    std::size_t position = 8;
    while (position + 12 <= bytes.size() && !bytes.has(position + 4, "IEND")) {
        position += std::size_t{12} + bytes.big32(position);
    }
    return position + 12 <= bytes.size();
}

/// SOF0 … SOF15 carry the size; C4, C8 and CC in that range are tables and reserved.
bool is_start_of_frame(std::uint32_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Walks the marker segments of a JPEG (ITU-T T.81, annex B) to the first start of frame.
ImageHeader jpeg_header(const ByteView& bytes) {
    std::size_t position = 2;
    while (position + 9 < bytes.size() && bytes.at(position) == 0xFF) {
        const std::uint32_t marker = bytes.at(position + 1);
        if (is_start_of_frame(marker)) {
            return {FileFormat::kJpeg, bytes.big16(position + 7), bytes.big16(position + 5)};
        }
        const bool is_fill_byte = marker == 0xFF;
        position += is_fill_byte ? 1 : 2 + bytes.big16(position + 2);
    }
    return {FileFormat::kJpeg, 0, 0};
}

/// The first chunk of a WebP file is VP8X (extended), VP8L (lossless) or VP8 (lossy); RFC 9649.
ImageHeader webp_header(const ByteView& bytes) {
    if (bytes.has(12, "VP8X")) {
        return {FileFormat::kWebp, bytes.little24(24) + 1, bytes.little24(27) + 1};
    }
    if (bytes.has(12, "VP8L") && bytes.at(20) == 0x2F) {
        const std::uint32_t packed = bytes.little16(21) | bytes.little16(23) << 16;
        return {FileFormat::kWebp, (packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1};
    }
    if (bytes.has(12, "VP8 ") && bytes.has(23, "\x9D\x01\x2A")) {
        return {FileFormat::kWebp, bytes.little16(26) & 0x3FFF, bytes.little16(28) & 0x3FFF};
    }
    return {FileFormat::kWebp, 0, 0};
}

} // namespace

Decoded<ImageHeader> read_image_header(std::span<const std::byte> encoded) {
    const ByteView bytes(encoded);
    ImageHeader header;
    if (bytes.has(0, "\x89PNG\r\n\x1A\n") && bytes.has(12, "IHDR")) {
        header = {FileFormat::kPng, bytes.big32(16), bytes.big32(20)};
    } else if (bytes.has(0, "\xFF\xD8\xFF")) {
        header = jpeg_header(bytes);
    } else if (bytes.has(0, "RIFF") && bytes.has(8, "WEBP")) {
        header = webp_header(bytes);
    } else {
        return decode_error("not a PNG, JPEG or WebP image");
    }
    if (header.format == FileFormat::kPng && !is_complete_png(bytes)) {
        return decode_error("truncated PNG");
    }
    if (header.width_px == 0 || header.height_px == 0) {
        return decode_error("damaged image header: no size");
    }
    return header;
}

} // namespace fieldcast::image
