// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/sources.h"

#include "core/lightfield/source_frame.h"

#include <algorithm>
#include <charconv>

namespace fieldcast {

namespace {

/// Reads a number at the front of `text` and takes it away.
std::optional<std::uint32_t> take_number(std::string_view& text) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) {
        return std::nullopt;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

bool take(std::string_view& text, char expected) {
    const bool is_there = text.starts_with(expected);
    text.remove_prefix(is_there ? 1 : 0);
    return is_there;
}

std::optional<std::vector<LatticePosition>> parse_list(std::string_view text, const ViewGrid& grid) {
    std::vector<LatticePosition> positions;
    do {
        const auto row = take_number(text);
        const bool has_comma = take(text, ',');
        const auto col = take_number(text);
        if (!row || !has_comma || !col || *row >= grid.rows || *col >= grid.cols) {
            return std::nullopt;
        }
        const LatticePosition position = lattice_position(grid, *row, *col);
        if (std::ranges::find(positions, position) != positions.end() || positions.size() == kMaxSources) {
            return std::nullopt;
        }
        positions.push_back(position);
    } while (take(text, ';'));
    return text.empty() ? std::optional(positions) : std::nullopt;
}

} // namespace

std::optional<std::vector<LatticePosition>> parse_sources(const std::string& text, const ViewGrid& grid) {
    const std::uint32_t bottom = grid.rows - 1;
    const std::uint32_t right = grid.cols - 1;
    std::vector<LatticePosition> positions;
    if (text == "middle") {
        return std::vector{LatticePosition{}};
    }
    if (text == "top-left") {
        positions = {lattice_position(grid, 0, 0)};
    } else if (text == "diagonal") {
        positions = {lattice_position(grid, 0, 0), lattice_position(grid, bottom, right)};
    } else if (text == "triangle") {
        positions = {lattice_position(grid, 0, 0), lattice_position(grid, 0, right),
                     lattice_position(grid, bottom, right / 2)};
    } else if (text == "corners") {
        positions = {lattice_position(grid, 0, 0), lattice_position(grid, 0, right), lattice_position(grid, bottom, 0),
                     lattice_position(grid, bottom, right)};
    } else {
        return parse_list(text, grid);
    }
    std::ranges::sort(positions); // grids of one row or column have fewer corners
    const auto repeated = std::ranges::unique(positions);
    positions.erase(repeated.begin(), repeated.end());
    return positions;
}

} // namespace fieldcast
