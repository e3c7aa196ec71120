// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/lightfield/vocabulary.h"
#include "core/scene/scene.h"
#include "core/wire/frame_assembler.h"
#include "core/wire/frame_limits.h"
#include "core/wire/view_set.h"

#include "fieldcast/v1/light_field.pb.h"

#include <optional>
#include <string>
#include <vector>

namespace fieldcast::client::net {

/// Limits for changes that the server makes by itself when the connection carries less than we ask for. Zero: no change
/// of that kind.
struct AdaptationBounds {
    bool allows_jpeg = true;
    std::uint8_t min_quality = 40;
    float min_frames_per_second = 2.0F;
    std::uint32_t min_view_height_px = 180;
    std::uint32_t min_rows = 3;
    std::uint32_t min_cols = 3;
    bool allows_scene = false;            ///< we have the scene and can make views
    std::uint32_t max_queue_delay_ms = 0; ///< longest delay of frames in queues on the way; 0: the server's choice
};

/// What the client asks a server for. Zero or unset: the value of the server's channel.
struct Request {
    std::string channel;
    DeliveryMode mode = DeliveryMode::kViews;
    std::uint32_t rows = 4;
    std::uint32_t cols = 4;
    Anchor anchor = Anchor::kLattice;
    std::optional<float> spacing_m;     ///< between columns and between rows
    std::optional<float> convergence_m; ///< 0: parallel
    std::uint32_t width_px = 0;         ///< of a view; set together with height_px
    std::uint32_t height_px = 0;
    float fovy_rad = 0.0F; ///< vertical
    PlaneSet planes = PlaneSet::kWithGBuffer; ///< of mode kScene
    bool has_coarse_normals = false; ///< of kWithGBuffer: normals of 8 bits a component rather than 16
    bool has_residual = true; ///< of mode kWarp: also the surfaces that only corner views see, not the source
    /// For views, for the illumination in mode kScene, and for colour in mode kWarp; the preferred one first. Other
    /// planes are always lossless.
    std::vector<Codec> codecs{Codec::kZstdFiltered};
    std::uint8_t quality = 0; ///< of lossy codecs, 1 to 100; 0: the server's choice
    float max_frames_per_second = 0.0F;
    std::optional<AdaptationBounds> adaptation{}; ///< unset: the server must not change anything by itself
};

/// A change that the server has made by itself, and its reason.
struct Adapted {
    std::uint32_t level = 0;  ///< number of steps away from the request
    bool is_recovery = false; ///< a step back towards the request
    std::uint32_t queue_delay_ms = 0;
    std::uint64_t delivered_bytes_per_second = 0; ///< 0: unknown
    std::string change;                           ///< description for people; printable
};

/// A plane that every frame has, and its maximum size.
struct PlaneBound {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
};

/// A configuration that the server has granted.
struct Agreement {
    std::uint32_t epoch = 0;
    std::string channel;
    scene::SceneHash scene_hash{};
    DeliveryMode mode = DeliveryMode::kViews;
    wire::ViewSet view_set;
    wire::FrameLimits limits;       ///< for every frame of this epoch
    std::vector<PlaneBound> planes; ///< of source frames, in their order; empty in mode kViews
    float frames_per_second = 0.0F; ///< most that the server intends to send; 0: unknown
    Request request;                ///< the request it answers; after a change by the server, with its changes
    std::optional<Adapted> adapted{}; ///< set: the server's own change within `request.adaptation`
};

/// The Configure message that asks for `request`.
v1::Configure to_configure(const Request& request, std::uint32_t request_id);

/// Checks that a Configured answers `request`. Mode and grid must be as requested or, if the server has adapted, within
/// `request.adaptation`. Sizes must be within what a client can hold.
Decoded<Agreement> from_configured(const v1::Configured& message, const Request& request);

/// Why a frame does not match the agreement, or nothing. If nothing, views have the agreed number and size; source
/// frames have the planes from which views are made, and no view is larger than the source.
std::optional<std::string> frame_problem(const wire::ReceivedFrame& frame, const Agreement& agreement);

} // namespace fieldcast::client::net
