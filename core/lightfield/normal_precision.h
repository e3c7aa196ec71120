// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

namespace fieldcast {

/// Normals of `plane`, which is kOct2x16, in kOct2x8: each component becomes the nearest of 255. The direction changes
/// by less than 1°.
Plane coarse_normals(const Plane& plane);

/// Normals of `plane`, which is kOct2x8, in kOct2x16. coarse_normals() of the result is `plane` again, but for
/// components of −128, which count as −127.
Plane fine_normals(const Plane& plane);

} // namespace fieldcast
