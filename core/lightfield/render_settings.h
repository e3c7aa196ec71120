// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/vocabulary.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fieldcast {

enum class ToneMap : std::uint8_t { kClampSrgb = 0, kAces = 1 };

/// Thresholds of the spatial reprojection test, in units of the pixel footprint ρ = 2 z tan(fovy/2) / H
/// (docs/lightfield.md). They are scale-free, so no scene needs constants of its own.
struct ReprojectionThresholds {
    float plane_footprints = 1.5F;      ///< |n·(P_s − P_t)| ≤ plane_footprints · ρ + 1e-4 z
    float tangential_footprints = 2.5F; ///< |P_s − P_t| ≤ tangential_footprints · ρ / |n·v|
    float min_normal_cos = 0.35F;       ///< shading normals of target and source
    float min_weight = 0.05F;           ///< sum of accepted bilinear weights

    bool operator==(const ReprojectionThresholds&) const = default;
};

/// Methods that fill pixels which the source does not show, cheapest first. The remaining pixels are path traced
/// (docs/lightfield.md).
struct HoleFilling {
    bool previous_frame = true;     ///< average a hole's own light over frames; trace settled holes every fourth frame
    bool isolated = true;           ///< isolated holes take light of the same surface around their place in the source
    std::uint32_t cascade_rows = 0; ///< inner views take holes from the corner views of a grid with this many rows …
    std::uint32_t cascade_cols = 0; ///< … and columns, anchored on the lattice; 0: none
    bool end_in_source = true;      ///< paths end on surfaces that the source shows
    bool denoise = true;            ///< smooth the light of holes over their surface

    static constexpr HoleFilling path_traced() { return {false, false, 0, 0, false, false}; }
    bool operator==(const HoleFilling&) const = default;
};

/// Reads "all", "none" or a list of previous, isolated, cascade, source, denoise; the cascade is that of a grid of
/// `rows` × `cols`. Empty if malformed.
std::optional<HoleFilling> parse_hole_filling(const std::string& text, std::uint32_t rows, std::uint32_t cols);

inline constexpr std::uint32_t kMaxLightCandidates = 64;

/// Choice of the light sample in next event estimation; every choice is unbiased (docs/lightfield.md).
struct LightSampling {
    std::uint32_t candidates = 4; ///< 1 to 64, unshadowed, at the first two vertices; resampling keeps one
    bool each_kind = true; ///< at the first vertex: a sample of each kind of light (environment, emissive, punctual)

    /// One sample of all lights, as in the paper.
    static constexpr LightSampling plain() { return {1, false}; }
    bool operator==(const LightSampling&) const = default;
};

/// Random numbers of the source's paths; both values stand for Owen-scrambled Sobol points. kSobol: each pixel has its
/// own sequence. kZSobol: all pixels share one sequence, shifted from pixel to pixel along a Z-order curve, so that
/// neighbours complement one another.
enum class Sampler : std::uint8_t { kSobol, kZSobol };

/// Every parameter that changes a pixel, on the server or at the client. Each frame header contains them.
struct RenderSettings {
    std::uint32_t samples_per_pixel = 1;
    std::uint32_t max_bounces = 8;
    bool next_event_estimation = true;
    LightSampling light_sampling;
    Sampler sampler = Sampler::kZSobol;
    /// The source's paths end on surfaces that the previous frame showed, and use its light there. Not used where views
    /// are denoised or still frames are averaged (docs/lightfield.md).
    bool history_light = true;
    /// Luminance limit of one indirect sample, × 0.18 / exposure; 0: unbiased. If only a small part of the picture is
    /// lit, the light there is far above the mean: a limit of 20 removed a third of Sponza's indirect light
    /// (docs/benchmarks.md).
    float indirect_clamp = 100.0F;
    Denoiser denoiser = Denoiser::kSvgfPlus;
    bool temporal_accumulation = true;
    float temporal_alpha = 0.2F; ///< paper, section 3.2
    /// Every view averages its own light over frames as well, with weight temporal_alpha, as in the paper.
    /// Denoised views do so anyway.
    bool accumulate_views = false;
    DenoisedImages denoised_images = DenoisedImages::kSource;
    /// Reference mode: while nothing moves, frames are averaged without limits and without denoiser.
    bool accumulate = false;
    ToneMap tone_map = ToneMap::kClampSrgb;
    float exposure = 1.0F; ///< multiplies linear radiance before the tone map
    ReprojectionThresholds reprojection;
    bool reflections = true; ///< smooth surfaces show each view its reflection; else their light sticks to them
    HoleFilling holes;

    bool operator==(const RenderSettings&) const = default;
};

} // namespace fieldcast
