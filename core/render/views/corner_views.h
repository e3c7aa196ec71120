// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/render_settings.h"
#include "core/lightfield/view_grid.h"

#include <vector>

namespace fieldcast::render {

/// Indices of the views whose holes fill those of the other views. Corner positions that are missing are appended to
/// `positions`.
std::vector<std::uint32_t> choose_corners(const HoleFilling& holes, std::vector<LatticePosition>& positions);

} // namespace fieldcast::render
