// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"
#include "server/channel/settings.h"

#include <cstddef>
#include <limits>
#include <string>

namespace fieldcast::channel {

/// Camera and lattice of a channel's light field.
struct Viewpoint {
    std::size_t camera = 0; ///< index into Scene::cameras
    float spacing_m = 0.0F;
    float convergence_m = std::numeric_limits<float>::infinity();
};

/// The camera that `settings` names, or else the file's. A file without a camera, or any file with `settings.framing`,
/// is framed automatically, which adds a camera to `scene`. Spacing and convergence follow from the depths that the
/// camera sees at the start, unless flags or file give them. `name`: the channel's name, for the log.
/// Throws UserError if there is no such camera.
Viewpoint settle_viewpoint(scene::Scene& scene, const Settings& settings, const std::string& name);

} // namespace fieldcast::channel
