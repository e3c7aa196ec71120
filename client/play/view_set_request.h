// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/view_request.h"
#include "core/wire/view_set.h"

namespace fieldcast::client::play {

/// Converts `set` to a request to a renderer; its views are row-major.
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
