// SPDX-License-Identifier: Apache-2.0
#include "core/render/source/source_planes.h"

#include "core/lightfield/normal_precision.h"

#include <algorithm>
#include <cstring>

namespace fieldcast::render {

namespace {

std::size_t index_of(PlaneSemantic semantic) {
    const auto found = std::ranges::find(kSourceSemantics, semantic);
    FC_ASSERT(found != kSourceSemantics.end(), "not a plane of a source frame");
    return static_cast<std::size_t>(found - kSourceSemantics.begin());
}

bool fits(const Plane& plane, const FrameHeader& header) {
    const Camera widened = with_guard_band(header.source, header.guard_band);
    const bool is_known = plane.semantic == PlaneSemantic::kTotalLight ||
                          std::ranges::find(kSourceSemantics, plane.semantic) != kSourceSemantics.end();
    return is_known && may_have_format(plane.semantic, plane.format) &&
           plane.width_px == widened.width_px && plane.height_px == plane_height(header, plane.semantic) &&
           plane.bytes.size() == plane_bytes(plane.format, plane.width_px, plane.height_px);
}

/// Pixels of 16 bits, each in the low half of a word.
std::vector<std::uint32_t> words_of(const Plane& plane) {
    std::vector<std::uint32_t> words(plane.bytes.size() / 2);
    for (std::size_t i = 0; i < words.size(); ++i) {
        words[i] = std::to_integer<std::uint32_t>(plane.bytes[2 * i]) |
                   std::to_integer<std::uint32_t>(plane.bytes[2 * i + 1]) << 8;
    }
    return words;
}

/// Keeps the low 16 bits of each word of 32.
void keep_low_halves(std::vector<std::byte>& bytes) {
    const std::size_t count = bytes.size() / 4;
    for (std::size_t i = 0; i < count; ++i) {
        bytes[2 * i] = bytes[4 * i];
        bytes[2 * i + 1] = bytes[4 * i + 1];
    }
    bytes.resize(count * 2);
}

} // namespace

SourcePlanes::SourcePlanes(const gpu::Device& device) : device_(device), readback_(device) {}

void SourcePlanes::resize(const FrameHeader& header) {
    header_ = header;
    const Camera widened = camera();
    pixel_count_ = widened.width_px * widened.height_px;
    if (texel_count() == allocated_texels_) {
        return;
    }
    allocated_texels_ = texel_count();
    for (gpu::Buffer& plane : planes_) {
        plane = gpu::Buffer(device_, static_cast<std::uint64_t>(allocated_texels_) * 4);
    }
}

SourceFrame SourcePlanes::download(std::span<const PlaneSemantic> wanted) const {
    SourceFrame frame{header_, {}};
    const Camera widened = camera();
    std::vector<gpu::ReadbackPart> parts;
    for (const PlaneSemantic semantic : wanted) {
        Plane plane{semantic, usual_format(semantic), widened.width_px, plane_height(header_, semantic), {}};
        plane.bytes.resize(static_cast<std::size_t>(plane.width_px) * plane.height_px * 4);
        frame.planes.push_back(std::move(plane)); // its bytes stay where they are when the vector grows
        parts.push_back({.buffer = &planes_[index_of(semantic)], .bytes = frame.planes.back().bytes});
    }
    readback_.read(std::move(parts));
    for (Plane& plane : frame.planes) {
        if (plane.format == PlaneFormat::kRg8) {
            keep_low_halves(plane.bytes);
        }
    }
    return frame;
}

Decoded<bool> SourcePlanes::upload(const SourceFrame& frame) {
    for (const Plane& plane : frame.planes) {
        if (!fits(plane, frame.header)) {
            return decode_error("plane " + std::to_string(static_cast<int>(plane.semantic)) +
                                ": format or size is not that of the source");
        }
    }
    resize(frame.header);
    for (const Plane& plane : frame.planes) {
        if (plane.semantic == PlaneSemantic::kTotalLight) {
            gpu::write_buffer(device_, planes_[index_of(PlaneSemantic::kDiffuse)], plane.bytes);
            gpu::write_buffer(device_, planes_[index_of(PlaneSemantic::kSpecular)], plane.bytes);
            continue;
        }
        const gpu::Buffer& buffer = planes_[index_of(plane.semantic)];
        if (plane.format == PlaneFormat::kRg8) {
            const std::vector<std::uint32_t> words = words_of(plane);
            gpu::write_buffer(device_, buffer, std::as_bytes(std::span(words)));
        } else if (plane.format == PlaneFormat::kOct2x8) {
            gpu::write_buffer(device_, buffer, fine_normals(plane).bytes);
        } else {
            gpu::write_buffer(device_, buffer, plane.bytes);
        }
    }
    return true;
}

const gpu::Buffer& SourcePlanes::plane(PlaneSemantic semantic) const {
    return planes_[index_of(semantic)];
}

} // namespace fieldcast::render
