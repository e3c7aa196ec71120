// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace fieldcast::scene {

/// Directional albedo of single-scattering GGX with Schlick's Fresnel, E = F0·x + y, on a grid of
/// shared::kGgxAlbedoSize² cells: columns n·v, rows roughness 0 … 1. z and w are 0.
/// B. Karis. Real Shading in Unreal Engine 4. 2013 ("environment BRDF"); here by stratified visible-normal sampling.
std::vector<glm::vec4> make_ggx_albedo();

} // namespace fieldcast::scene
