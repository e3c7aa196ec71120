// SPDX-License-Identifier: Apache-2.0
#include "client/net/configure.h"

#include "core/lightfield/frame_rate.h"
#include "core/wire/convert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace fieldcast::client::net {
namespace {

// Limits of a client, whatever a server announces.
constexpr std::uint32_t kMaxViewSide = 8192;
constexpr std::uint64_t kMaxFrameBytes = 1ULL << 30;

/// The planes of frames that answer `request`, in the order of the frames.
std::vector<PlaneSemantic> planes_of(const Request& request) {
    constexpr std::array kResidual{WarpPlane::kResidual};
    const std::span<const WarpPlane> extra(kResidual);
    return fieldcast::planes_of(request.mode, request.planes, extra.first(request.has_residual ? 1 : 0));
}

void add_codecs(v1::Configure& message, const Request& request, PlaneSemantic semantic) {
    v1::CodecPreference& preference = *message.add_codecs();
    preference.set_semantic(wire::to_proto(semantic));
    preference.set_quality(request.quality);
    for (const Codec codec : request.codecs) {
        preference.add_codecs(wire::to_proto(codec));
    }
}

void add_formats(v1::Configure& message, PlaneSemantic semantic) {
    const PlaneRow row = row_of(semantic);
    v1::CodecPreference& preference = *message.add_codecs();
    preference.set_semantic(wire::to_proto(semantic));
    preference.add_formats(wire::to_proto(*row.coarse_format));
    preference.add_formats(wire::to_proto(row.format)); // for servers and recordings without the coarse format
}

void add_planes(v1::Configure& message, const Request& request) {
    for (const PlaneSemantic semantic : planes_of(request)) {
        if (is_picture(semantic)) {
            add_codecs(message, request, semantic);
        } else if (request.has_coarse_normals && semantic == PlaneSemantic::kNormal) {
            add_formats(message, semantic);
        }
    }
    if (request.mode == DeliveryMode::kWarp && request.has_residual) {
        message.add_warp_planes(static_cast<v1::WarpPlane>(WarpPlane::kResidual));
    }
}

void add_adaptation(v1::Configure& message, const AdaptationBounds& allowed) {
    v1::Adaptation& bounds = *message.mutable_adaptation();
    if (allowed.allows_jpeg) {
        bounds.add_codecs(wire::to_proto(Codec::kJpeg));
    }
    bounds.set_min_quality(allowed.min_quality);
    bounds.set_min_frames_per_second(allowed.min_frames_per_second);
    bounds.set_min_view_height_px(allowed.min_view_height_px);
    bounds.set_min_rows(allowed.min_rows);
    bounds.set_min_cols(allowed.min_cols);
    if (allowed.allows_scene) {
        bounds.add_modes(wire::to_proto(DeliveryMode::kScene));
    }
    bounds.set_max_queue_delay_ms(allowed.max_queue_delay_ms);
}

/// `request` with the server's choice in everything that it may change by itself, within the bounds. An adapted
/// Configured is then checked like an answer to that request.
Request adapted_request(const v1::Configured& message, const Request& request) {
    const AdaptationBounds& bounds = *request.adaptation;
    Request adapted = request;
    if (bounds.allows_jpeg) {
        adapted.codecs.push_back(Codec::kJpeg);
    }
    const bool is_scene = message.mode() == wire::to_proto(DeliveryMode::kScene);
    if (bounds.allows_scene && is_scene && request.mode == DeliveryMode::kViews) {
        adapted.mode = DeliveryMode::kScene;
        adapted.planes = PlaneSet::kIllumination;
        return adapted;
    }
    const v1::ViewSet& set = message.view_set();
    const auto lowered = [](std::uint32_t asked, std::uint32_t chosen, std::uint32_t least) {
        return least > 0 && chosen >= std::min(least, asked) && chosen <= asked ? chosen : asked;
    };
    adapted.rows = lowered(request.rows, set.grid().rows(), bounds.min_rows);
    adapted.cols = lowered(request.cols, set.grid().cols(), bounds.min_cols);
    if (request.height_px != 0 && bounds.min_view_height_px != 0) {
        adapted.height_px = lowered(request.height_px, set.height_px(), bounds.min_view_height_px);
        adapted.width_px = lowered(request.width_px, set.width_px(), 1);
    }
    return adapted;
}

Adapted from_proto(const v1::Adapted& message) {
    return {.level = message.level(),
            .is_recovery = message.reason() == v1::ADAPTATION_REASON_RECOVERED,
            .queue_delay_ms = message.queue_delay_ms(),
            .delivered_bytes_per_second = message.delivered_bytes_per_second(),
            .change = message.change()};
}

/// Why the server must not use the codecs that it has chosen, or nothing.
std::optional<std::string> codec_problem(const v1::Configured& message, const Request& request) {
    for (const v1::PlaneHeader& plane : message.planes()) {
        const auto codec = wire::from_proto(plane.codec());
        const auto semantic = wire::from_proto(plane.semantic());
        const bool is_wanted =
            codec && (semantic && is_picture(*semantic)
                          ? std::find(request.codecs.begin(), request.codecs.end(), *codec) != request.codecs.end()
                          : !is_lossy(*codec));
        if (!is_wanted) {
            return "Configured: a codec that was not asked for";
        }
    }
    return std::nullopt;
}

std::optional<std::string> view_set_problem(const wire::ViewSet& set, const Request& request) {
    if (set.grid.rows != request.rows || set.grid.cols != request.cols || set.grid.anchor != request.anchor) {
        return "Configured: another grid than asked for";
    }
    if (request.width_px != 0 && (set.width_px != request.width_px || set.height_px != request.height_px)) {
        return "Configured: another view size than asked for";
    }
    if (set.width_px > kMaxViewSide || set.height_px > kMaxViewSide) {
        return "Configured: views beyond " + std::to_string(kMaxViewSide) + " px";
    }
    return std::nullopt;
}

std::optional<PlaneBound> plane_bound(const v1::PlaneHeader& plane) {
    const auto semantic = wire::from_proto(plane.semantic());
    const auto format = wire::from_proto(plane.format());
    const bool has_size = plane.width_px() > 0 && plane.width_px() <= kMaxPlaneSide && plane.height_px() > 0 &&
                          plane.height_px() <= kMaxPlaneSide;
    if (!semantic || !format || !has_size) {
        return std::nullopt;
    }
    return PlaneBound{*semantic, *format, plane.width_px(), plane.height_px()};
}

/// The planes that source frames have; empty for modes in which the server makes the views.
Decoded<std::vector<PlaneBound>> plane_bounds(const v1::Configured& message, DeliveryMode mode) {
    std::vector<PlaneBound> bounds;
    if (!is_made_by_client(mode)) {
        return bounds;
    }
    for (const v1::PlaneHeader& plane : message.planes()) {
        const std::optional<PlaneBound> bound = plane_bound(plane);
        if (!bound) {
            return decode_error("Configured: a plane has an unknown semantic or format, or a size outside 1 … 16384");
        }
        bounds.push_back(*bound);
    }
    return bounds;
}

/// The limits that follow from the sizes in Configured, which are upper bounds.
Decoded<wire::FrameLimits> frame_limits(const std::vector<PlaneBound>& planes, const wire::ViewSet& set,
                                        DeliveryMode mode) {
    wire::FrameLimits limits;
    limits.max_width_px = set.width_px;
    limits.max_height_px = set.height_px;
    limits.max_frame_bytes = plane_bytes(PlaneFormat::kRgb8, set.width_px, set.height_px) * set.grid.view_count();
    if (is_made_by_client(mode)) {
        limits.max_frame_bytes = 0;
        for (const PlaneBound& plane : planes) {
            limits.max_width_px = std::max(limits.max_width_px, plane.width_px);
            limits.max_height_px = std::max(limits.max_height_px, plane.height_px);
            limits.max_frame_bytes += plane_bytes(plane.format, plane.width_px, plane.height_px);
        }
    }
    if (limits.max_frame_bytes > kMaxFrameBytes) {
        return decode_error("Configured: frames of " + std::to_string(limits.max_frame_bytes >> 20) +
                            " MiB, at most 1024 MiB");
    }
    return limits;
}

std::optional<std::string> planes_problem(const std::vector<Plane>& planes, const std::vector<PlaneBound>& bounds) {
    const auto is_within = [](const Plane& plane, const PlaneBound& bound) {
        return plane.semantic == bound.semantic && plane.format == bound.format && plane.width_px <= bound.width_px &&
               plane.height_px <= bound.height_px;
    };
    if (!std::ranges::equal(planes, bounds, is_within)) {
        return "frame with other or larger planes than Configured announced";
    }
    return std::nullopt;
}

std::optional<std::string> source_problem(const SourceFrame& frame, const wire::ViewSet& set, DeliveryMode mode) {
    const auto has_all = [&](std::span<const PlaneSemantic> planes) {
        return std::ranges::all_of(planes, [&](PlaneSemantic semantic) { return frame.find(semantic) != nullptr; });
    };
    const ModeRow row = row_of(mode);
    const bool has_light =
        std::ranges::any_of(kAll<PlaneSet>, [&](PlaneSet planes) { return has_all(row_of(planes).planes); });
    if (!has_all(row.planes) || (row.needs_scene && !has_light)) {
        return "frame without the planes from which views are made";
    }
    const Camera& source = frame.header.source;
    if (set.height_px > source.height_px || set.width_px > source.width_px) {
        return "frame whose source is smaller than the views";
    }
    return std::nullopt;
}

std::optional<std::string> views_problem(const wire::ReceivedViews& views, const wire::ViewSet& set) {
    if (views.set != set || views.views.views.size() != set.grid.view_count()) {
        return "frame with other views than agreed";
    }
    return std::nullopt;
}

} // namespace

v1::Configure to_configure(const Request& request, std::uint32_t request_id) {
    v1::Configure message;
    message.set_request_id(request_id);
    message.set_channel(request.channel);
    message.add_modes(wire::to_proto(request.mode));
    v1::Grid& grid = *message.mutable_grid();
    grid.set_rows(request.rows);
    grid.set_cols(request.cols);
    grid.set_anchor(request.anchor == Anchor::kCentre ? v1::ANCHOR_CENTRE : v1::ANCHOR_LATTICE);
    if (request.spacing_m) {
        grid.set_spacing_x_m(*request.spacing_m);
        grid.set_spacing_y_m(*request.spacing_m);
    }
    if (request.convergence_m) {
        grid.set_convergence_m(*request.convergence_m);
    }
    message.set_view_width_px(request.width_px);
    message.set_view_height_px(request.height_px);
    message.set_fovy_rad(request.fovy_rad);
    message.set_planes(static_cast<v1::PlaneSet>(request.planes));
    add_planes(message, request);
    message.set_max_frames_per_second(request.max_frames_per_second);
    message.set_keeps_key_frames(true);
    if (request.adaptation) {
        add_adaptation(message, *request.adaptation);
    }
    return message;
}

Decoded<Agreement> from_configured(const v1::Configured& message, const Request& asked) {
    if (message.has_adapted() && !asked.adaptation) {
        return decode_error("Configured: adapted, although the request does not allow it");
    }
    const Request request = message.has_adapted() ? adapted_request(message, asked) : asked;
    Agreement agreement;
    agreement.epoch = message.epoch();
    agreement.channel = message.channel();
    agreement.mode = request.mode;
    if (message.mode() != wire::to_proto(request.mode)) {
        return decode_error("Configured: another delivery mode than asked for");
    }
    if (message.epoch() == 0 || message.scene_hash().size() != agreement.scene_hash.size()) {
        return decode_error("Configured: epoch 0 or no scene hash of 32 bytes");
    }
    std::copy(message.scene_hash().begin(), message.scene_hash().end(), agreement.scene_hash.begin());
    const Decoded<wire::ViewSet> set = wire::from_proto(message.view_set());
    if (!set) {
        return decode_error("Configured: " + set.error().message);
    }
    agreement.view_set = *set;
    if (const auto problem = view_set_problem(*set, request)) {
        return decode_error(*problem);
    }
    if (const auto problem = codec_problem(message, request)) {
        return decode_error(*problem);
    }
    Decoded<std::vector<PlaneBound>> planes = plane_bounds(message, request.mode);
    if (!planes) {
        return tl::unexpected(planes.error());
    }
    agreement.planes = std::move(*planes);
    const Decoded<wire::FrameLimits> limits = frame_limits(agreement.planes, *set, request.mode);
    if (!limits) {
        return tl::unexpected(limits.error());
    }
    agreement.limits = *limits;
    agreement.request = request;
    agreement.adapted = message.has_adapted() ? std::optional(from_proto(message.adapted())) : std::nullopt;
    const float rate = message.frames_per_second();
    agreement.frames_per_second = is_rate_bound(rate) ? rate : 0.0F;
    return agreement;
}

std::optional<std::string> frame_problem(const wire::ReceivedFrame& frame, const Agreement& agreement) {
    const auto* views = std::get_if<wire::ReceivedViews>(&frame.content);
    if ((views == nullptr) != is_made_by_client(agreement.mode)) {
        return "frame of another delivery mode than agreed";
    }
    if (views != nullptr) {
        return views_problem(*views, agreement.view_set);
    }
    const auto& source = std::get<SourceFrame>(frame.content);
    const auto problem = planes_problem(source.planes, agreement.planes);
    return problem ? problem : source_problem(source, agreement.view_set, agreement.mode);
}

} // namespace fieldcast::client::net
