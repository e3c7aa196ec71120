// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace fieldcast {

enum class Denoiser : std::uint8_t { kNone = 0, kSvgf = 1 };
enum class ToneMap : std::uint8_t { kClampSrgb = 0, kAces = 1 };

/// Thresholds of the spatial reprojection test, in units of the pixel footprint ρ = 2 z tan(fovy/2) / H
/// (docs/lightfield.md). Scale-free, so no constants per scene.
struct ReprojectionThresholds {
    float plane_footprints = 1.5F;      ///< |n·(P_s − P_t)| ≤ plane_footprints · ρ + 1e-4 z
    float tangential_footprints = 2.5F; ///< |P_s − P_t| ≤ tangential_footprints · ρ / |n·v|
    float min_normal_cos = 0.35F;       ///< shading normals of target and source
    float min_weight = 0.05F;           ///< sum of accepted bilinear weights

    bool operator==(const ReprojectionThresholds&) const = default;
};

/// Every parameter that changes a pixel, on both sides of the wire. Travels in each frame header.
struct RenderSettings {
    std::uint32_t samples_per_pixel = 1;
    std::uint32_t max_bounces = 8;
    bool next_event_estimation = true;
    float indirect_clamp = 20.0F; ///< luminance limit of one indirect sample, × 0.18 / exposure; 0: unbiased
    Denoiser denoiser = Denoiser::kSvgf;
    bool temporal_accumulation = true;
    float temporal_alpha = 0.2F; ///< paper, section 3.2
    ToneMap tone_map = ToneMap::kClampSrgb;
    float exposure = 1.0F; ///< multiplies linear radiance before the tone map
    ReprojectionThresholds reprojection;

    bool operator==(const RenderSettings&) const = default;
};

} // namespace fieldcast
