// SPDX-License-Identifier: Apache-2.0
// Follows: Portable Network Graphics (PNG) Specification (Third Edition), W3C, 2025, sections 5 and 11.3.6 (animation).
// The still frames come from the PNG encoder; their IDAT chunks become the fdAT chunks of one file.
#include "core/image/animated_png.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"
#include "core/image/image_file.h"

#include <cstdint>
#include <map>
#include <string_view>
#include <zlib.h>

namespace fieldcast::image {

namespace {

constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kChunkOverheadBytes = 12; // length, type, CRC

using Bytes = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

void append(Bytes& to, ByteSpan bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}

void append_big16(Bytes& to, std::uint32_t value) {
    to.push_back(static_cast<std::byte>(value >> 8 & 0xFFU));
    to.push_back(static_cast<std::byte>(value & 0xFFU));
}

void append_big32(Bytes& to, std::uint32_t value) {
    append_big16(to, value >> 16);
    append_big16(to, value & 0xFFFFU);
}

std::uint32_t read_big32(ByteSpan bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes.first(4)) {
        value = value << 8 | std::to_integer<std::uint32_t>(byte);
    }
    return value;
}

void append_chunk(Bytes& to, std::string_view type, ByteSpan body) {
    append_big32(to, static_cast<std::uint32_t>(body.size()));
    const std::size_t covered_from = to.size();
    append(to, std::as_bytes(std::span(type)));
    append(to, body);
    const ByteSpan covered = ByteSpan(to).subspan(covered_from);
    const auto* const data = reinterpret_cast<const Bytef*>(covered.data());
    append_big32(to, static_cast<std::uint32_t>(crc32_z(0, data, covered.size())));
}

/// Parts of a still PNG: whole chunks between IHDR and the pixels, and the bodies of its IDAT chunks joined into one.
struct StillImage {
    Bytes header;
    Bytes between;
    Bytes pixels;
};

StillImage take_apart(ByteSpan png) {
    StillImage still;
    for (ByteSpan rest = png.subspan(kSignatureBytes); rest.size() >= kChunkOverheadBytes;) {
        const std::size_t body_bytes = read_big32(rest);
        const ByteSpan chunk = rest.first(body_bytes + kChunkOverheadBytes);
        const ByteSpan body = chunk.subspan(8, body_bytes);
        const std::string_view type(reinterpret_cast<const char*>(chunk.data()) + 4, 4);
        if (type == "IHDR") {
            append(still.header, body);
        } else if (type == "IDAT") {
            append(still.pixels, body);
        } else if (still.pixels.empty()) {
            append(still.between, chunk);
        }
        rest = rest.subspan(chunk.size());
    }
    return still;
}

void append_frame_control(Bytes& to, std::uint32_t sequence, const Plane& frame, std::uint32_t delay_ms) {
    Bytes body;
    append_big32(body, sequence);
    append_big32(body, frame.width_px);
    append_big32(body, frame.height_px);
    append_big32(body, 0); // x
    append_big32(body, 0); // y
    append_big16(body, delay_ms);
    append_big16(body, 1000); // delay is in 1/1000 s
    append_big16(body, 0);    // keep the frame, replace the content before it
    append_chunk(to, "fcTL", body);
}

/// Each frame has two sequence numbers, one for its control and one for its pixels, except the first, whose pixels are
/// the still image.
void append_frame(Bytes& to, std::size_t index, const Plane& frame, ByteSpan pixels, std::uint32_t delay_ms) {
    const auto sequence = static_cast<std::uint32_t>(index == 0 ? 0 : 2 * index - 1);
    append_frame_control(to, sequence, frame, delay_ms);
    if (index == 0) {
        append_chunk(to, "IDAT", pixels);
        return;
    }
    Bytes body;
    append_big32(body, sequence + 1);
    append(body, pixels);
    append_chunk(to, "fdAT", body);
}

} // namespace

std::vector<std::byte> encode_animated_png(std::span<const Plane* const> frames, std::chrono::milliseconds delay) {
    FC_ASSERT(!frames.empty(), "an animation has frames");
    FC_ASSERT(delay.count() > 0 && delay.count() <= 0xFFFF, "delay fits 16 bits");
    const auto delay_ms = static_cast<std::uint32_t>(delay.count());
    const Bytes first_png = encode_png(*frames.front());
    const StillImage first = take_apart(first_png);
    Bytes encoded(first_png.begin(), first_png.begin() + kSignatureBytes);
    append_chunk(encoded, "IHDR", first.header);
    Bytes control;
    append_big32(control, static_cast<std::uint32_t>(frames.size()));
    append_big32(control, 0); // plays: for ever
    append_chunk(encoded, "acTL", control);
    append(encoded, first.between);

    std::map<const Plane*, Bytes> compressed{{frames.front(), first.pixels}};
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Plane& frame = *frames[i];
        FC_ASSERT(frame.width_px == frames[0]->width_px && frame.height_px == frames[0]->height_px, "one size");
        if (!compressed.contains(&frame)) {
            compressed.emplace(&frame, take_apart(encode_png(frame)).pixels);
        }
        append_frame(encoded, i, frame, compressed.at(&frame), delay_ms);
    }
    append_chunk(encoded, "IEND", {});
    return encoded;
}

void write_animated_png(const std::filesystem::path& file, std::span<const Plane* const> frames,
                        std::chrono::milliseconds delay) {
    write_file_atomically(file, encode_animated_png(frames, delay));
}

} // namespace fieldcast::image
