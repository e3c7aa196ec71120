// SPDX-License-Identifier: Apache-2.0
#include "core/wire/frame_parts.h"

#include "core/wire/convert.h"

#include <algorithm>
#include <string>
#include <utility>

namespace fieldcast::wire {

namespace {

constexpr int kMaxPlanes = 16;

Decoded<void> check_size(std::uint32_t width_px, std::uint32_t height_px, const FrameLimits& limits) {
    const std::string size = std::to_string(width_px) + "x" + std::to_string(height_px);
    if (width_px == 0 || height_px == 0 || width_px > limits.max_width_px || height_px > limits.max_height_px) {
        return decode_error("header: planes of " + size + " pixels, at most " + std::to_string(limits.max_width_px) +
                            "x" + std::to_string(limits.max_height_px));
    }
    return {};
}

Decoded<Part> part_from_proto(const v1::PlaneHeader& message, const FrameHeader& header) {
    const auto semantic = from_proto(message.semantic());
    const auto format = from_proto(message.format());
    const auto codec = from_proto(message.codec());
    if (!semantic || !format || !codec) {
        return decode_error("header.planes: unknown semantic, format or codec");
    }
    if (!may_have_format(*semantic, *format)) {
        return decode_error("header.planes: semantic " + std::to_string(message.semantic()) +
                            " is not sent in format " + std::to_string(message.format()));
    }
    if (!carries(*codec, *format)) {
        return decode_error("header.planes: codec " + std::to_string(message.codec()) + " is not for format " +
                            std::to_string(message.format()));
    }
    if (message.width_px() != plane_width(header, *semantic) ||
        message.height_px() != plane_height(header, *semantic)) {
        return decode_error("header.planes: size differs from the source with guard band (and layers), or the tiles");
    }
    if (*format == PlaneFormat::kR16 && !(header.inverse_depth_unit > 0.0F)) {
        return decode_error("header.inverse_depth_unit: must be above 0 for planes of inverse depth");
    }
    return Part{*semantic, *format, message.width_px(), message.height_px(), *codec};
}

Decoded<std::vector<Part>> with_checked_total(std::vector<Part> parts, const FrameLimits& limits) {
    std::uint64_t total = 0;
    for (const Part& part : parts) {
        const std::uint64_t bytes = plane_bytes(part.format, part.width_px, part.height_px);
        if (bytes > kMaxPlaneBytes) {
            return decode_error("header: a plane of " + std::to_string(bytes) + " bytes");
        }
        total += bytes;
    }
    if (total > limits.max_frame_bytes) {
        return decode_error("header: frame of " + std::to_string(total) + " bytes, at most " +
                            std::to_string(limits.max_frame_bytes));
    }
    return parts;
}

} // namespace

Decoded<std::vector<Part>> parts_of_planes(const v1::PlanesHeader& message, const FrameHeader& header,
                                           const FrameLimits& limits) {
    if (message.planes_size() == 0 || message.planes_size() > kMaxPlanes) {
        return decode_error("header.planes: 1 to " + std::to_string(kMaxPlanes) + " planes");
    }
    const Camera widened = with_guard_band(header.source, header.guard_band);
    if (const auto checked = check_size(widened.width_px, widened.height_px, limits); !checked) {
        return tl::unexpected(checked.error());
    }
    std::vector<Part> parts;
    for (const v1::PlaneHeader& entry : message.planes()) {
        auto part = part_from_proto(entry, header);
        if (!part) {
            return tl::unexpected(part.error());
        }
        if (std::ranges::find(parts, part->semantic, &Part::semantic) != parts.end()) {
            return decode_error("header.planes: semantic " + std::to_string(entry.semantic()) + " twice");
        }
        parts.push_back(std::move(*part));
    }
    return with_checked_total(std::move(parts), limits);
}

Decoded<std::vector<Part>> parts_of_views(const v1::ViewsHeader& message, const ViewSet& set,
                                          const FrameLimits& limits) {
    const auto codec = from_proto(message.codec());
    if (!codec) {
        return decode_error("header.views: unknown codec");
    }
    if (const auto checked = check_size(set.width_px, set.height_px, limits); !checked) {
        return tl::unexpected(checked.error());
    }
    const Part view{PlaneSemantic::kColour, PlaneFormat::kRgb8, set.width_px, set.height_px, *codec};
    return with_checked_total(std::vector<Part>(set.grid.view_count(), view), limits);
}

Decoded<std::vector<DiscardCounts>> discards_from_proto(const v1::FrameTrailer& message, const ViewSet& set) {
    if (static_cast<std::uint32_t>(message.discards_size()) != set.grid.view_count()) {
        return decode_error("trailer.discards: " + std::to_string(message.discards_size()) + " entries for " +
                            std::to_string(set.grid.view_count()) + " views");
    }
    std::vector<DiscardCounts> discards;
    for (const v1::DiscardCounts& entry : message.discards()) {
        const std::uint64_t total = std::uint64_t{entry.out_of_frustum()} + entry.id() + entry.plane() + entry.normal();
        if (total > std::uint64_t{set.width_px} * set.height_px) {
            return decode_error("trailer.discards: more pixels than the view has");
        }
        discards.push_back(from_proto(entry));
    }
    return discards;
}

} // namespace fieldcast::wire
