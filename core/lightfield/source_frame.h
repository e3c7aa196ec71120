// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/lightfield/plane.h"
#include "core/lightfield/render_settings.h"
#include "core/lightfield/residual_layer.h"
#include "core/lightfield/view_grid.h"

#include <optional>
#include <string>
#include <vector>

namespace fieldcast {

/// Duration of one stage of a frame.
struct StageTime {
    std::string stage;
    double ms = 0.0;

    bool operator==(const StageTime&) const = default;
};

/// The pose that a client chose and a frame shows.
struct AppliedPose {
    std::uint64_t lease = 0;         ///< of the client that steers the camera, > 0
    std::uint64_t sequence = 0;      ///< within the lease
    std::int64_t client_time_ns = 0; ///< when it was chosen, on that client's steady clock

    bool operator==(const AppliedPose&) const = default;
};

inline constexpr std::uint32_t kMaxLayers = 2;
inline constexpr std::size_t kMaxSources = 8; ///< source images of a frame

/// All that a receiver needs to know about a frame besides its pixels.
struct FrameHeader {
    std::uint64_t frame_id = 0;     ///< grows by at least 1 per frame of a channel
    std::int64_t scene_time_ns = 0; ///< poses every animation of the scene
    bool cut = false;               ///< histories are void: loop wrap, teleport, scene change
    std::uint32_t seed = 0;         ///< of the channel; with noise_frame it determines all random numbers of the frame
    std::uint32_t noise_frame = 0;  ///< position in the random sequences; consecutive frames continue them
    Camera source;                  ///< at lattice position (0, 0), without guard band
    GuardBand guard_band;           ///< planes are the source image plus this band
    /// Lattice positions of the source images in `source_geometry`, at most kMaxSources, without duplicates.
    std::vector<LatticePosition> source_positions = middle_source();
    LatticeGeometry source_geometry;
    RenderSettings settings;
    /// BLEND surfaces in front of the source's visible surfaces, 0 or kMaxLayers. Their illumination is stacked below
    /// the images' in the illumination planes, which are (1 + layer_count) times as high.
    std::uint32_t layer_count = 0;
    /// Number of frames of which the illumination is the plain average, while nothing moves and the settings ask for it
    /// (accumulate); 0: the usual accumulation.
    std::uint32_t still_frames = 0;
    /// Step of planes that hold inverse depth, 1/m; 0: no such planes.
    float inverse_depth_unit = 0.0F;
    ResidualLayer residual; ///< of planes kResidual…
    std::optional<AppliedPose> applied_pose; ///< the pose that `source` shows; empty: no client has steered the camera
    std::vector<StageTime> render_times;

    bool operator==(const FrameHeader&) const = default;
};

/// Result of path tracing one frame, in wire precision. It is the interface between server and clients.
struct SourceFrame {
    FrameHeader header;
    std::vector<Plane> planes; ///< of plane_width() and plane_height(), at most one per semantic

    const Plane* find(PlaneSemantic semantic) const; ///< null if absent
};

/// Camera of source image `index`, guard band included. All have one size.
Camera widened_source(const FrameHeader& header, std::size_t index);

/// Whether planes with that semantic hold demodulated light.
bool is_illumination(PlaneSemantic semantic);

/// Planes are stacks of pages, each of the widened source's size: first the visible surfaces, source by source, then
/// (illumination only) the nearest BLEND surface in front of them, source by source, then the next.
std::uint32_t page_count(const FrameHeader& header, PlaneSemantic semantic);

/// Whether planes with that semantic hold tiles of `FrameHeader::residual`.
bool is_residual(PlaneSemantic semantic);

/// Width of a plane of a source frame: the widened source's, or that of the tiles of the residual layer.
std::uint32_t plane_width(const FrameHeader& header, PlaneSemantic semantic);

/// Height of a plane of a source frame: the widened source's height times the number of pages of the semantic, or the
/// height of the tiles of the residual layer.
std::uint32_t plane_height(const FrameHeader& header, PlaneSemantic semantic);

} // namespace fieldcast
