// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/view_request.h"
#include "core/wire/frame_assembler.h"

namespace fieldcast::client::play {

/// The views of `set`, row-major, as renderers want to be asked.
inline render::ViewRequest view_set_request(const wire::ViewSet& set) {
    render::ViewRequest request;
    request.geometry = set.grid.geometry;
    request.fovy_rad = set.fovy_rad;
    request.width_px = set.width_px;
    request.height_px = set.height_px;
    request.positions = lattice_positions(set.grid);
    return request;
}

} // namespace fieldcast::client::play
