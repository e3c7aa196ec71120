// SPDX-License-Identifier: Apache-2.0
// RenderSettings and small values. convert.cpp has cameras, grids and view sets, convert_header.cpp frame headers.
#include "core/wire/convert.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace fieldcast::wire {

namespace {

constexpr std::uint32_t kMaxSamplesPerPixel = 65536;
constexpr std::uint32_t kMaxBounces = 256;

/// The value with that number, or nothing. Our enumerations and those of the messages have the same numbers
/// (tests/wire/vocabulary_test.cpp).
template <class Enum> std::optional<Enum> known(int number) {
    return number < 0 ? std::nullopt : from_number<Enum>(static_cast<std::uint64_t>(number));
}

v1::ToneMap tone_map_to_proto(ToneMap tone_map) {
    switch (tone_map) {
    case ToneMap::kClampSrgb:
        return v1::TONE_MAP_CLAMP_SRGB;
    case ToneMap::kAces:
        return v1::TONE_MAP_ACES;
    }
    return v1::TONE_MAP_UNSPECIFIED;
}

std::optional<ToneMap> tone_map_from_proto(int number) {
    switch (number) {
    case v1::TONE_MAP_CLAMP_SRGB:
        return ToneMap::kClampSrgb;
    case v1::TONE_MAP_ACES:
        return ToneMap::kAces;
    default: // messages may hold any number
        return std::nullopt;
    }
}

/// A float of the settings and its range. NaN is in no range.
struct BoundedFloat {
    const char* name;
    float value;
    float min;
    float max;
};

Decoded<void> check_floats(const RenderSettings& settings) {
    constexpr float kMax = std::numeric_limits<float>::max();
    constexpr float kMin = std::numeric_limits<float>::min();
    const ReprojectionThresholds& limits = settings.reprojection;
    const std::array<BoundedFloat, 7> fields{{
        {"indirect_clamp", settings.indirect_clamp, 0.0F, kMax},
        {"temporal_alpha", settings.temporal_alpha, 0.0F, 1.0F},
        {"exposure", settings.exposure, kMin, kMax},
        {"reprojection.plane_footprints", limits.plane_footprints, 0.0F, kMax},
        {"reprojection.tangential_footprints", limits.tangential_footprints, 0.0F, kMax},
        {"reprojection.min_normal_cos", limits.min_normal_cos, -1.0F, 1.0F},
        {"reprojection.min_weight", limits.min_weight, 0.0F, 1.0F},
    }};
    for (const BoundedFloat& field : fields) {
        if (!(field.value >= field.min && field.value <= field.max)) {
            return decode_error(std::string("settings.") + field.name + ": " + std::to_string(field.value) +
                                " is out of range");
        }
    }
    return {};
}

Decoded<void> check_counts(const v1::RenderSettings& message) {
    if (message.samples_per_pixel() == 0 || message.samples_per_pixel() > kMaxSamplesPerPixel) {
        return decode_error("settings.samples_per_pixel: 1 to " + std::to_string(kMaxSamplesPerPixel));
    }
    if (message.max_bounces() > kMaxBounces) {
        return decode_error("settings.max_bounces: at most " + std::to_string(kMaxBounces));
    }
    if (message.light_sampling().candidates() > kMaxLightCandidates) {
        return decode_error("settings.light_sampling.candidates: at most " + std::to_string(kMaxLightCandidates));
    }
    if (message.sampler() > v1::SAMPLER_Z_SOBOL || message.sampler() < 0) {
        return decode_error("settings.sampler: unknown sampler " + std::to_string(message.sampler()));
    }
    return {};
}

void to_proto(const HoleFilling& holes, v1::HoleFilling& message) {
    message.set_previous_frame(holes.previous_frame);
    message.set_isolated(holes.isolated);
    message.set_cascade_rows(holes.cascade_rows);
    message.set_cascade_cols(holes.cascade_cols);
    message.set_end_in_source(holes.end_in_source);
    message.set_denoise(holes.denoise);
}

Decoded<HoleFilling> from_proto(const v1::HoleFilling& message) {
    if (message.cascade_rows() > kMaxViews || message.cascade_cols() > kMaxViews) {
        return decode_error("settings.holes: at most " + std::to_string(kMaxViews) + " cascade_rows and cascade_cols");
    }
    return HoleFilling{message.previous_frame(), message.isolated(),      message.cascade_rows(),
                       message.cascade_cols(),   message.end_in_source(), message.denoise()};
}

} // namespace

void to_proto(const RenderSettings& settings, v1::RenderSettings& message) {
    message.set_samples_per_pixel(settings.samples_per_pixel);
    message.set_max_bounces(settings.max_bounces);
    message.set_next_event_estimation(settings.next_event_estimation);
    message.set_indirect_clamp(settings.indirect_clamp);
    message.set_denoiser(static_cast<v1::Denoiser>(settings.denoiser));
    message.set_temporal_accumulation(settings.temporal_accumulation);
    message.set_temporal_alpha(settings.temporal_alpha);
    message.set_tone_map(tone_map_to_proto(settings.tone_map));
    message.set_exposure(settings.exposure);
    v1::ReprojectionThresholds& thresholds = *message.mutable_reprojection();
    thresholds.set_plane_footprints(settings.reprojection.plane_footprints);
    thresholds.set_tangential_footprints(settings.reprojection.tangential_footprints);
    thresholds.set_min_normal_cos(settings.reprojection.min_normal_cos);
    thresholds.set_min_weight(settings.reprojection.min_weight);
    message.mutable_light_sampling()->set_candidates(settings.light_sampling.candidates);
    message.mutable_light_sampling()->set_each_kind(settings.light_sampling.each_kind);
    to_proto(settings.holes, *message.mutable_holes());
    message.set_accumulate(settings.accumulate);
    message.set_reflections(settings.reflections);
    message.set_history_light(settings.history_light);
    message.set_sampler(settings.sampler == Sampler::kZSobol ? v1::SAMPLER_Z_SOBOL : v1::SAMPLER_SOBOL);
    message.set_accumulate_views(settings.accumulate_views);
    message.set_denoised_images(static_cast<v1::DenoisedImages>(settings.denoised_images));
}

Decoded<RenderSettings> from_proto(const v1::RenderSettings& message) {
    const auto denoiser = known<Denoiser>(message.denoiser());
    const auto tone_map = tone_map_from_proto(message.tone_map());
    const bool is_set = message.denoised_images() != v1::DENOISED_IMAGES_UNSPECIFIED; // old senders only had kSource
    const auto images = is_set ? known<DenoisedImages>(message.denoised_images()) : DenoisedImages::kSource;
    if (!denoiser || !tone_map || !images) {
        return decode_error("settings: unknown denoiser, tone map or denoised images");
    }
    RenderSettings settings;
    settings.samples_per_pixel = message.samples_per_pixel();
    settings.max_bounces = message.max_bounces();
    if (const auto checked = check_counts(message); !checked) {
        return tl::unexpected(checked.error());
    }
    settings.light_sampling = {std::max(message.light_sampling().candidates(), 1U),
                               message.light_sampling().each_kind()};
    settings.next_event_estimation = message.next_event_estimation();
    settings.indirect_clamp = message.indirect_clamp();
    settings.denoiser = *denoiser;
    settings.temporal_accumulation = message.temporal_accumulation();
    settings.temporal_alpha = message.temporal_alpha();
    settings.tone_map = *tone_map;
    settings.exposure = message.exposure();
    settings.reprojection = {message.reprojection().plane_footprints(), message.reprojection().tangential_footprints(),
                             message.reprojection().min_normal_cos(), message.reprojection().min_weight()};
    const auto holes = from_proto(message.holes());
    if (!holes) {
        return tl::unexpected(holes.error());
    }
    settings.holes = *holes;
    settings.accumulate = message.accumulate();
    settings.reflections = message.reflections();
    settings.history_light = message.history_light();
    settings.sampler = message.sampler() == v1::SAMPLER_Z_SOBOL ? Sampler::kZSobol : Sampler::kSobol;
    settings.accumulate_views = message.accumulate_views();
    settings.denoised_images = *images;
    if (const auto checked = check_floats(settings); !checked) {
        return tl::unexpected(checked.error());
    }
    return settings;
}

void to_proto(const DiscardCounts& counts, v1::DiscardCounts& message) {
    message.set_out_of_frustum(counts.out_of_frustum);
    message.set_id(counts.id);
    message.set_plane(counts.plane);
    message.set_normal(counts.normal);
}

DiscardCounts from_proto(const v1::DiscardCounts& message) {
    return {message.out_of_frustum(), message.id(), message.plane(), message.normal()};
}

void to_proto(const ServerTimes& times, v1::ServerTimes& message) {
    message.set_pose_sampled_ns(times.pose_sampled_ns);
    message.set_render_begin_ns(times.render_begin_ns);
    message.set_render_end_ns(times.render_end_ns);
    message.set_encode_begin_ns(times.encode_begin_ns);
    message.set_encode_end_ns(times.encode_end_ns);
    message.set_send_begin_ns(times.send_begin_ns);
    message.set_send_end_ns(times.send_end_ns);
}

ServerTimes from_proto(const v1::ServerTimes& message) {
    return {message.pose_sampled_ns(), message.render_begin_ns(), message.render_end_ns(), message.encode_begin_ns(),
            message.encode_end_ns(),   message.send_begin_ns(),   message.send_end_ns()};
}

v1::Codec to_proto(Codec codec) {
    return static_cast<v1::Codec>(codec);
}

v1::PlaneSemantic to_proto(PlaneSemantic semantic) {
    return static_cast<v1::PlaneSemantic>(semantic);
}

v1::PlaneFormat to_proto(PlaneFormat format) {
    return static_cast<v1::PlaneFormat>(format);
}

v1::DeliveryMode to_proto(DeliveryMode mode) {
    return static_cast<v1::DeliveryMode>(mode);
}

std::optional<Codec> from_proto(v1::Codec codec) {
    return known<Codec>(codec);
}

std::optional<PlaneSemantic> from_proto(v1::PlaneSemantic semantic) {
    return known<PlaneSemantic>(semantic);
}

std::optional<PlaneFormat> from_proto(v1::PlaneFormat format) {
    return known<PlaneFormat>(format);
}

std::optional<DeliveryMode> from_proto(v1::DeliveryMode mode) {
    return known<DeliveryMode>(mode);
}

} // namespace fieldcast::wire
