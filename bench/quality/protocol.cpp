// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/protocol.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

std::vector<LatticePosition> positions_of(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& views) {
    const ViewGrid grid; // 6×6
    std::vector<LatticePosition> positions;
    for (const auto& [row, col] : views) {
        positions.push_back(lattice_position(grid, row, col));
    }
    return positions;
}

} // namespace

bool Protocol::is_scored(std::uint32_t frame) const {
    return std::ranges::find(frames, frame) != frames.end();
}

std::vector<PictureId> Protocol::pictures() const {
    std::vector<PictureId> pictures;
    for (const std::uint32_t frame : frames) {
        for (const LatticePosition view : views) {
            pictures.push_back({frame, view});
        }
    }
    return pictures;
}

Protocol find_protocol(const std::string& name) {
    if (name == "reduced") {
        return {name, {320, 180}, {11, 23, 29}, positions_of({{0, 0}, {0, 5}, {2, 3}, {5, 0}, {5, 5}}), 1024};
    }
    if (name == "full") {
        return {name,
                {1280, 720},
                {5, 11, 17, 23, 29},
                positions_of({{0, 0}, {0, 2}, {0, 5}, {2, 0}, {2, 2}, {2, 5}, {5, 0}, {5, 2}, {5, 5}}),
                4096};
    }
    throw UserError("--protocol " + name + ": expected reduced or full");
}

} // namespace fieldcast::bench
