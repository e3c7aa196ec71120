// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/lightfield/views.h"
#include "core/wire/server_times.h"
#include "core/wire/view_set.h"

#include "fieldcast/v1/frame.pb.h"
#include "fieldcast/v1/types.pb.h"

#include <google/protobuf/repeated_field.h>
#include <optional>

// The only conversions between Protobuf messages and our types. `from_proto` checks every field: enumerators must be
// known, and numbers finite and within the range that the proto file states. Errors name the field.
namespace fieldcast::wire {

/// Writes all but the frame id, which is a field of the chunk.
void to_proto(const FrameHeader& header, v1::FrameHeader& message);
Decoded<FrameHeader> from_proto(const v1::FrameHeader& message, std::uint64_t frame_id);

void to_proto(const Camera& camera, v1::PinholeCamera& message);
Decoded<Camera> from_proto(const v1::PinholeCamera& message);
/// The pose in 12 values, ordered as in PinholeCamera.world_from_camera. An error unless it is rigid and within 1e9 m.
Decoded<glm::mat4> pose_from_proto(const google::protobuf::RepeatedField<float>& values);

void to_proto(const GuardBand& band, v1::GuardBand& message);
Decoded<GuardBand> from_proto(const v1::GuardBand& message);

void to_proto(const RenderSettings& settings, v1::RenderSettings& message);
Decoded<RenderSettings> from_proto(const v1::RenderSettings& message);

/// Writes every field. The convergence of parallel cameras is written as 0.
void to_proto(const ViewGrid& grid, v1::Grid& message);
/// Takes unset fields from `channel`. The result has no grid_problem().
Decoded<ViewGrid> from_proto(const v1::Grid& message, const LatticeGeometry& channel);

void to_proto(const ViewSet& set, v1::ViewSet& message);
Decoded<ViewSet> from_proto(const v1::ViewSet& message);

void to_proto(const DiscardCounts& counts, v1::DiscardCounts& message);
DiscardCounts from_proto(const v1::DiscardCounts& message);

void to_proto(const ServerTimes& times, v1::ServerTimes& message);
ServerTimes from_proto(const v1::ServerTimes& message);

v1::Codec to_proto(Codec codec);
v1::PlaneSemantic to_proto(PlaneSemantic semantic);
v1::PlaneFormat to_proto(PlaneFormat format);
v1::DeliveryMode to_proto(DeliveryMode mode);
std::optional<Codec> from_proto(v1::Codec codec);
std::optional<PlaneSemantic> from_proto(v1::PlaneSemantic semantic);
std::optional<PlaneFormat> from_proto(v1::PlaneFormat format);
std::optional<DeliveryMode> from_proto(v1::DeliveryMode mode);

} // namespace fieldcast::wire
