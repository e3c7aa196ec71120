// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/received_chunks.h"

#include "core/codec/crc32c.h"

namespace fieldcast::fuzz {

namespace {

/// Every plane that was decoded has all its pixels.
void expect_whole(const Plane& plane) {
    const bool is_empty = plane.bytes.empty(); // pixels that were not asked for
    FC_ASSERT(is_empty || plane.bytes.size() == plane_bytes(plane.format, plane.width_px, plane.height_px),
              "a plane has all its pixels");
}

void expect_whole(const wire::ReceivedFrame& frame) {
    if (const auto* const views = std::get_if<wire::ReceivedViews>(&frame.content)) {
        FC_ASSERT(views->views.views.size() == views->set.grid.view_count(), "all views are there");
        for (const View& view : views->views.views) {
            expect_whole(view.image);
        }
        return;
    }
    for (const Plane& plane : std::get<SourceFrame>(frame.content).planes) {
        expect_whole(plane);
    }
}

} // namespace

void ReceivedChunks::begin_epoch(std::uint32_t epoch, const wire::FrameLimits& limits) {
    limits_ = limits;
    assembler_.begin_epoch(epoch, limits);
}

std::optional<wire::ReceivedFrame> ReceivedChunks::add(v1::FrameChunk chunk) {
    if (chunk.has_header()) {
        crc32c_ = 0;
    }
    crc32c_ = codec::crc32c(std::as_bytes(std::span(chunk.payload())), crc32c_);
    if (chunk.has_trailer()) {
        chunk.mutable_trailer()->set_crc32c(crc32c_);
    }
    auto added = assembler_.add(std::move(chunk));
    if (!added) {
        FC_ASSERT(!added.error().message.empty(), "an error says what is wrong");
        ++error_count_;
        return std::nullopt;
    }
    if (*added) {
        expect_whole(**added);
    }
    return std::move(*added);
}

} // namespace fieldcast::fuzz
