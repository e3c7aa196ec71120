// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"
#include "core/lightfield/view_grid.h"

#include <span>
#include <vector>

namespace fieldcast::bench {

/// A picture with one square per view of `grid`, row-major: dark for value 0, bright for `brightest` and more. Squares
/// of `sources` have a white dot.
Plane heat_map(const ViewGrid& grid, std::span<const double> values, double brightest,
               const std::vector<LatticePosition>& sources);

} // namespace fieldcast::bench
