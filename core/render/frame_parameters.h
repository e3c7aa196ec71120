// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/lightfield/source_frame.h"
#include "shaders/shared/frame.h"

#include <algorithm>

namespace fieldcast::render {

/// The bits kFlag… for kernels, from a frame's settings.
inline std::uint32_t kernel_flags(const RenderSettings& settings) {
    return settings.tone_map == ToneMap::kAces ? shared::kFlagAces : 0U;
}

/// The bits kPath… for kernels: bounces, light candidates, next event estimation, sampler.
inline std::uint32_t path_bits(const RenderSettings& settings) {
    return settings.max_bounces | settings.light_sampling.candidates << shared::kPathCandidatesShift |
           (settings.next_event_estimation ? shared::kPathNextEventEstimation : 0U) |
           (settings.light_sampling.each_kind ? shared::kPathEachLightKind : 0U) |
           (settings.sampler == Sampler::kZSobol ? shared::kPathScreenSampler : 0U);
}

/// Whether views are denoised instead of the source. An average of still frames needs no denoiser.
inline bool denoises_views(const FrameHeader& header) {
    return header.settings.denoised_images == DenoisedImages::kViews && header.still_frames == 0;
}
/// Whether views themselves are averaged over time or denoised.
inline bool filters_views(const FrameHeader& header) {
    return denoises_views(header) || (header.settings.accumulate_views && header.still_frames == 0);
}

/// Whether direct diffuse light of punctual lights is traced, averaged and filtered apart from other light. This
/// requires that SVGF+ denoises the source and that each kind of light has its own sample.
inline bool keeps_punctual_apart(const FrameHeader& header) {
    const RenderSettings& settings = header.settings;
    return settings.denoiser == Denoiser::kSvgfPlus && settings.denoised_images == DenoisedImages::kSource &&
           settings.next_event_estimation && settings.light_sampling.each_kind;
}

/// Hole filling of a frame. Averages of still frames path trace and average their holes, without bias. Views that are
/// averaged or denoised as a whole include their holes in that, so the hole filler does not do it again.
inline HoleFilling hole_filling(const FrameHeader& header) {
    HoleFilling holes = header.settings.holes;
    if (header.still_frames > 0) {
        holes = HoleFilling::path_traced();
    }
    holes.previous_frame = header.still_frames > 0 || (holes.previous_frame && !filters_views(header));
    holes.denoise = holes.denoise && !denoises_views(header);
    return holes;
}

/// Least weight of a new frame in an average; 0: all frames weigh the same.
inline float least_weight(const FrameHeader& header) {
    return header.still_frames > 0 ? 0.0F : header.settings.temporal_alpha;
}

/// Luminance at which one indirect contribution is clamped; 0: no clamp. The setting is relative to the frame's mean,
/// which exposure brings to 0.18.
inline float max_indirect(const RenderSettings& settings) {
    return settings.indirect_clamp * 0.18F / settings.exposure;
}
inline float max_indirect(const FrameHeader& header) {
    return header.still_frames > 0 ? 0.0F : max_indirect(header.settings);
}

inline shared::ReprojectSettings reproject_settings(const FrameHeader& header) {
    const ReprojectionThresholds& thresholds = header.settings.reprojection;
    return {thresholds.plane_footprints, thresholds.tangential_footprints, thresholds.min_normal_cos,
            thresholds.min_weight, static_cast<std::uint32_t>(header.source_positions.size())};
}

/// Number of workgroups for `items` in a kernel that uses lib/linear_index.glsl.
inline gpu::GroupCount linear_groups(std::uint32_t items) {
    const std::uint32_t groups = gpu::groups_for(items, shared::kLinearGroup);
    return {std::min(groups, shared::kLinearGroupsX), gpu::groups_for(groups, shared::kLinearGroupsX), 1};
}

/// The hash of lib/random.glsl.
std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b);

/// Seed for the pixels of one view. It depends on the frame and the lattice position, so every view has its own noise.
std::uint32_t view_seed(const FrameHeader& header, LatticePosition position);

/// Appends the stage times of the recorder's last submission.
void append_times(const gpu::CommandRecorder& recorder, std::vector<StageTime>& times);

} // namespace fieldcast::render
