// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/lightfield/vocabulary.h"
#include "core/scene/scene.h"
#include "core/wire/frame_assembler.h"

#include "fieldcast/v1/light_field.pb.h"

#include <optional>
#include <string>
#include <vector>

namespace fieldcast::client::net {

/// What the server may change by itself when the connection carries less than we ask for. Zero: nothing of that kind.
struct AdaptationBounds {
    bool allows_jpeg = true;
    std::uint8_t min_quality = 40;
    float min_frames_per_second = 2.0F;
    std::uint32_t min_view_height_px = 180;
    std::uint32_t min_rows = 3;
    std::uint32_t min_cols = 3;
    bool allows_scene = false;            ///< we hold the scene and can make views
    std::uint32_t max_queue_delay_ms = 0; ///< that frames may spend waiting on the way; 0: the server's choice
};

/// What to ask a server for. Zero or unset: as the server's channel has it.
struct Request {
    std::string channel;
    DeliveryMode mode = DeliveryMode::kViews;
    std::uint32_t rows = 4;
    std::uint32_t cols = 4;
    Anchor anchor = Anchor::kLattice;
    std::optional<float> spacing_m;     ///< between columns and between rows
    std::optional<float> convergence_m; ///< 0: parallel
    std::uint32_t width_px = 0;         ///< of a view, together with height_px
    std::uint32_t height_px = 0;
    float fovy_rad = 0.0F; ///< vertical
    PlaneSet planes = PlaneSet::kWithGBuffer; ///< of mode kScene
    bool has_coarse_normals = false; ///< of kWithGBuffer: 8 bits a component rather than 16
    bool has_residual = true; ///< of mode kWarp: also what corner views see and the source does not
    /// Of views, of the illumination in mode kScene or of colour in mode kWarp, most wanted first; other planes are
    /// always lossless.
    std::vector<Codec> codecs{Codec::kZstdFiltered};
    std::uint8_t quality = 0; ///< of lossy codecs, 1 to 100; 0: the server's choice
    float max_frames_per_second = 0.0F;
    std::optional<AdaptationBounds> adaptation{}; ///< unset: nothing changes unless we ask
};

/// Why the server has changed a configuration by itself.
struct Adapted {
    std::uint32_t level = 0; ///< steps away from what was asked for
    bool is_recovery = false;
    std::uint32_t queue_delay_ms = 0;
    std::uint64_t delivered_bytes_per_second = 0; ///< 0: unknown
    std::string change;                           ///< for people; printable
};

/// A plane that every frame has, and the most that it may measure.
struct PlaneBound {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
};

/// What the server grants.
struct Agreement {
    std::uint32_t epoch = 0;
    std::string channel;
    scene::SceneHash scene_hash{};
    DeliveryMode mode = DeliveryMode::kViews;
    wire::ViewSet view_set;
    wire::FrameLimits limits;       ///< for every frame of this epoch
    std::vector<PlaneBound> planes; ///< of source frames, in their order; empty in mode kViews
    float frames_per_second = 0.0F; ///< that the server means to send at most; 0: it does not say
    Request request;                      ///< that it answers
    std::optional<Adapted> adapted{}; ///< set: a change within `request.adaptation`, not an answer
};

v1::Configure to_configure(const Request& request, std::uint32_t request_id);

/// Checks that a Configured answers `request`: mode and grid as asked, or within what `request.adaptation` allows if the
/// server says that it has adapted; everything within what a client can hold.
Decoded<Agreement> from_configured(const v1::Configured& message, const Request& request);

/// Why a frame does not fit what was agreed, or nothing. Afterwards views have the agreed number and size, and source
/// frames contain the planes that views are made from and no view is larger than the source.
std::optional<std::string> frame_problem(const wire::ReceivedFrame& frame, const Agreement& agreement);

} // namespace fieldcast::client::net
