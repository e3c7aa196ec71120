// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/convert.h"

#include "fieldcast/v1/light_field.pb.h"

#include <vector>

// The planes that a Configure asks for, and its preferences for each.
namespace fieldcast::session {

/// The planes that a client with that Configure gets in `mode`, in the order of the stream.
std::vector<PlaneSemantic> asked_planes(const v1::Configure& wanted, DeliveryMode mode);

/// The codecs, formats and quality wanted for one plane; null: the Configure does not name that plane.
const v1::CodecPreference* find_preference(const v1::Configure& wanted, PlaneSemantic semantic);

} // namespace fieldcast::session
