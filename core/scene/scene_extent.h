// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

namespace fieldcast::scene {

/// How far from the origin anything may be. Beyond, single precision has no use and soon no range.
inline constexpr float kMaxExtent_m = 1e9F;

/// Throws UserError unless all nodes and all instances lie within `kMaxExtent_m`, over the whole animation as far as a
/// number of samples tells, and at least one triangle is shown. Finite numbers may still multiply to infinity.
void check_extent(const Scene& scene);

} // namespace fieldcast::scene
