// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/chunks.h"
#include "core/wire/frame_assembler.h"

#include "fieldcast/v1/light_field.pb.h"
#include "tests/wire/test_planes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

// Frames, and the way from WireChunks to the assembler that gRPC takes in a real session.
namespace fieldcast::testing {

inline FrameHeader test_header(std::uint64_t frame_id, std::uint32_t width_px = 50, std::uint32_t height_px = 130) {
    FrameHeader header;
    header.frame_id = frame_id;
    header.scene_time_ns = -123'456'789'012;
    header.cut = true;
    header.seed = 0xDEADBEEF;
    const glm::mat4 moved = glm::translate(glm::mat4(1.0F), glm::vec3(1.5F, -2.0F, 3.25F));
    header.source = make_camera(glm::rotate(moved, 0.7F, glm::vec3(0.0F, 1.0F, 0.0F)), 0.8F, width_px, height_px);
    header.guard_band = {3, 4, 1, 2};
    header.settings.samples_per_pixel = 3;
    header.settings.next_event_estimation = false;
    header.settings.history_light = false;
    header.settings.tone_map = ToneMap::kAces;
    header.settings.exposure = 0.18F;
    header.settings.reprojection.min_weight = 0.0F;
    header.settings.holes = {false, true, 6, 5, true, false};
    header.noise_frame = 17;
    header.inverse_depth_unit = 0.125F;
    header.render_times = {{"trace", 4.25}, {"denoise", 0.0}};
    return header;
}

/// A source frame with a plane of every usual format (ids included), ramps with a different seed per frame.
inline SourceFrame test_source(std::uint64_t frame_id) {
    SourceFrame frame{test_header(frame_id), {}};
    const Camera widened = with_guard_band(frame.header.source, frame.header.guard_band);
    for (const PlaneFormat format : kUsualFormats) {
        frame.planes.push_back(
            ramp_plane(format, widened.width_px, widened.height_px, static_cast<std::uint32_t>(frame_id)));
    }
    return frame;
}

inline std::vector<wire::PlaneChoice> all_choices() {
    std::vector<wire::PlaneChoice> choices;
    for (const PlaneFormat format : kUsualFormats) {
        choices.push_back({semantic_of(format), {Codec::kZstdFiltered}});
    }
    return choices;
}

/// Every view of `grid`, each with other pixels and counts.
inline Views test_views(const ViewGrid& grid, std::uint32_t width_px, std::uint32_t height_px) {
    Views views{test_header(9), {}};
    std::uint32_t seed = 0;
    for (const LatticePosition position : lattice_positions(grid)) {
        views.views.push_back({position, ramp_plane(PlaneFormat::kRgb8, width_px, height_px, seed), {seed, 1, 2, 3}});
        ++seed;
    }
    return views;
}

/// As a receiver sees it: parsed from the bytes on the wire.
inline v1::FrameChunk received(const wire::WireChunk& chunk) {
    v1::ServerMessage message;
    EXPECT_TRUE(message.ParseFromString(wire::joined(chunk)));
    EXPECT_TRUE(message.has_frame_chunk());
    return message.frame_chunk();
}

/// All chunks of a frame, trailer included.
inline std::vector<v1::FrameChunk> all_chunks(const wire::WireFrame& frame, const wire::ServerTimes& times = {}) {
    std::vector<v1::FrameChunk> chunks;
    for (const wire::WireChunk& chunk : frame.chunks) {
        chunks.push_back(received(chunk));
    }
    chunks.push_back(received(wire::trailer_chunk(frame, times)));
    return chunks;
}

/// Adds chunks until one of them completes the frame or fails.
inline Decoded<std::optional<wire::ReceivedFrame>> add_all(wire::FrameAssembler& assembler,
                                                           const std::vector<v1::FrameChunk>& chunks) {
    for (const v1::FrameChunk& chunk : chunks) {
        auto added = assembler.add(chunk);
        if (!added || *added) {
            return added;
        }
    }
    return std::nullopt;
}

} // namespace fieldcast::testing
