// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"
#include "shaders/shared/scene.h"

#include <vector>

namespace fieldcast::scene {

/// What next event estimation draws from, and with which probabilities.
struct LightTables {
    std::vector<shared::EmitterRecord> emitters;        ///< all triangles of emissive instances, instance by instance
    std::vector<std::uint32_t> first_emitter;           ///< per instance; kNoIndex: does not emit
    std::vector<shared::AliasRecord> environment;       ///< one per environment texel
    std::vector<float> light_probability;               ///< per punctual light
    float probability_environment = 0.0F;
    float probability_emitter = 0.0F;
    float probability_light = 0.0F;
};

/// Probabilities follow the square root of the emitted power, with a floor for every kind there is: the strongest
/// light of a scene (often the sun) is not the one that matters everywhere.
LightTables make_light_tables(const Scene& scene, const ScenePose& pose, float scene_radius_m);

/// Punctual lights as placed by `pose`.
std::vector<shared::LightRecord> make_light_records(const Scene& scene, const ScenePose& pose,
                                                    const std::vector<float>& probability);

} // namespace fieldcast::scene
