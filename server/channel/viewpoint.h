// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"
#include "server/channel/settings.h"

#include <cstddef>
#include <limits>
#include <string>

namespace fieldcast::channel {

/// Where a channel's light field is seen from.
struct Viewpoint {
    std::size_t camera = 0; ///< index into Scene::cameras
    float spacing_m = 0.0F;
    float convergence_m = std::numeric_limits<float>::infinity();
};

/// The camera that `settings` names, or else the file's. A file without one is framed by itself, as are scenes for
/// which `settings.framing` says something: a camera is added to `scene` then. Spacing and convergence that neither
/// flags nor file give follow from the depths that the camera sees at the start. `name` is the channel's, for the log.
/// Throws UserError if there is no such camera.
Viewpoint settle_viewpoint(scene::Scene& scene, const Settings& settings, const std::string& name);

} // namespace fieldcast::channel
