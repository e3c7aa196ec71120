// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/lightfield/plane.h"
#include "core/lightfield/render_settings.h"
#include "core/lightfield/view_grid.h"

#include <string>
#include <vector>

namespace fieldcast {

/// Duration of one stage of a frame.
struct StageTime {
    std::string stage;
    double ms = 0.0;

    bool operator==(const StageTime&) const = default;
};

/// All that a receiver needs to know about a frame besides its pixels.
struct FrameHeader {
    std::uint64_t frame_id = 0;     ///< grows by at least 1 per frame of a channel
    std::int64_t scene_time_ns = 0; ///< poses every animation of the scene
    bool cut = false;               ///< histories are void: loop wrap, teleport, scene change
    std::uint32_t seed = 0;         ///< frame seed of all random numbers
    Camera source;                  ///< without guard band
    GuardBand guard_band;           ///< planes are the source image plus this band
    RenderSettings settings;
    std::vector<StageTime> render_times;

    bool operator==(const FrameHeader&) const = default;
};

/// What one frame of path tracing yields, in wire precision: the border between server and clients.
struct SourceFrame {
    FrameHeader header;
    std::vector<Plane> planes; ///< each of with_guard_band(source, guard_band) size, at most one per semantic

    const Plane* find(PlaneSemantic semantic) const; ///< null if absent
};

} // namespace fieldcast
