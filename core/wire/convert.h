// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/codec/plane_codec.h"
#include "core/lightfield/views.h"
#include "core/wire/chunks.h"
#include "core/wire/frame_assembler.h"

#include "fieldcast/v1/frame.pb.h"
#include "fieldcast/v1/types.pb.h"

#include <google/protobuf/repeated_field.h>

// Protobuf messages <-> our types, in this one place. `from_proto` checks every field: enums known, numbers finite and
// in the range that the proto file states. Errors name the field.
namespace fieldcast::wire {

/// Frame id excepted: it stands in the chunk.
void to_proto(const FrameHeader& header, v1::FrameHeader& message);
Decoded<FrameHeader> from_proto(const v1::FrameHeader& message, std::uint64_t frame_id);

void to_proto(const Camera& camera, v1::PinholeCamera& message);
Decoded<Camera> from_proto(const v1::PinholeCamera& message);
/// Of 12 values, as PinholeCamera.world_from_camera.
Decoded<glm::mat4> pose_from_proto(const google::protobuf::RepeatedField<float>& values);

void to_proto(const GuardBand& band, v1::GuardBand& message);
Decoded<GuardBand> from_proto(const v1::GuardBand& message);

void to_proto(const RenderSettings& settings, v1::RenderSettings& message);
Decoded<RenderSettings> from_proto(const v1::RenderSettings& message);

/// Writes every field; parallel cameras as convergence 0.
void to_proto(const ViewGrid& grid, v1::Grid& message);
/// Unset fields are taken from `channel`. The result has no grid_problem().
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
