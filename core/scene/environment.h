// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/load_options.h"
#include "core/scene/scene.h"

namespace fieldcast::scene {

/// Reads the environment image; without one, returns the constant sky. Throws UserError.
Environment read_environment(const LoadOptions& options);

/// Throws UserError unless `sky` is finite and not negative.
void check_sky(const glm::vec3& sky);

} // namespace fieldcast::scene
