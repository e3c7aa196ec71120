// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/lightfield/source_frame.h"
#include "shaders/shared/frame.h"

#include <algorithm>

namespace fieldcast::render {

/// Flags of a frame's settings for kernels.
inline std::uint32_t kernel_flags(const RenderSettings& settings) {
    return settings.tone_map == ToneMap::kAces ? shared::kFlagAces : 0U;
}

/// How paths are traced, for kernels.
inline std::uint32_t path_bits(const RenderSettings& settings) {
    return settings.max_bounces | settings.light_sampling.candidates << shared::kPathCandidatesShift |
           (settings.next_event_estimation ? shared::kPathNextEventEstimation : 0U) |
           (settings.light_sampling.each_kind ? shared::kPathEachLightKind : 0U) |
           (settings.sampler == Sampler::kZSobol ? shared::kPathScreenSampler : 0U);
}

/// Whether views are denoised rather than the source. An average of still frames needs no denoiser.
inline bool denoises_views(const FrameHeader& header) {
    return header.settings.denoised_images == DenoisedImages::kViews && header.still_frames == 0;
}
/// Views are averaged over time or denoised themselves.
inline bool filters_views(const FrameHeader& header) {
    return denoises_views(header) || (header.settings.accumulate_views && header.still_frames == 0);
}

/// Diffuse light straight from punctual lights is traced, averaged and filtered apart from other light: where the
/// source is denoised by SVGF+ and each kind of light has a sample of its own.
inline bool keeps_punctual_apart(const FrameHeader& header) {
    const RenderSettings& settings = header.settings;
    return settings.denoiser == Denoiser::kSvgfPlus && settings.denoised_images == DenoisedImages::kSource &&
           settings.next_event_estimation && settings.light_sampling.each_kind;
}

/// Hole filling of a frame: one that is an average of still frames averages its holes as well, without bias; views that
/// are averaged or denoised as a whole do that to their holes.
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

/// Luminance above which one indirect contribution is cut: relative to the frame's mean, which exposure brings to 0.18.
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

/// Groups of a kernel that uses lib/linear_index.glsl.
inline gpu::GroupCount linear_groups(std::uint32_t items) {
    const std::uint32_t groups = gpu::groups_for(items, shared::kLinearGroup);
    return {std::min(groups, shared::kLinearGroupsX), gpu::groups_for(groups, shared::kLinearGroupsX), 1};
}

/// Same hash as lib/random.glsl.
std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b);

/// Seed of the pixels of one view: of the frame and of the lattice position, so that every view has its own noise.
std::uint32_t view_seed(const FrameHeader& header, LatticePosition position);

/// Appends the stage times of the recorder's last submission.
void append_times(const gpu::Recorder& recorder, std::vector<StageTime>& times);

} // namespace fieldcast::render
