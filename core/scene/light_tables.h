// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"
#include "shaders/shared/scene.h"

#include <vector>

namespace fieldcast::scene {

/// Tables and probabilities from which next event estimation draws lights.
struct LightTables {
    std::vector<shared::EmitterRecord> emitters;        ///< all triangles of emissive instances, instance by instance
    std::vector<std::uint32_t> first_emitter;           ///< per instance; kNoIndex: does not emit
    std::vector<shared::AliasRecord> environment;       ///< one per environment texel
    std::vector<float> light_probability;               ///< per punctual light
    float probability_environment = 0.0F;
    float probability_emitter = 0.0F;
    float probability_light = 0.0F;
};

/// Probabilities are proportional to the square root of the emitted power, with a minimum for every kind of light in
/// the scene. The strongest light (often the sun) does not dominate everywhere.
LightTables make_light_tables(const Scene& scene, const ScenePose& pose, float scene_radius_m);

/// Punctual lights as placed by `pose`.
std::vector<shared::LightRecord> make_light_records(const Scene& scene, const ScenePose& pose,
                                                    const std::vector<float>& probability);

} // namespace fieldcast::scene
