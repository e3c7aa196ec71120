// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <optional>
#include <string>
#include <vector>

namespace fieldcast {

/// Reads which views of `grid` are source images: "middle" (lattice position (0, 0)), "top-left", "diagonal" (top left
/// and bottom right), "triangle" (top left, top right, middle of the bottom row), "corners" – the five configurations
/// of the light field paper, section 4.2 – or a list of views of the grid, "ROW,COL" separated by semicolons. Empty if
/// the text is malformed, names a view outside the grid, names a view twice, or names more than kMaxSources views.
std::optional<std::vector<LatticePosition>> parse_sources(const std::string& text, const ViewGrid& grid);

} // namespace fieldcast
