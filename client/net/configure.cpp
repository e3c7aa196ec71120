// SPDX-License-Identifier: Apache-2.0
#include "client/net/configure.h"

#include "core/lightfield/frame_rate.h"
#include "core/wire/convert.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::client::net {
namespace {

// What one client holds at most, whatever a server claims.
constexpr std::uint32_t kMaxViewSide = 8192;
constexpr std::uint64_t kMaxFrameBytes = 1ULL << 30;

v1::DeliveryMode to_proto(Mode mode) {
    switch (mode) {
    case Mode::kViews:
        return v1::DELIVERY_MODE_VIEWS;
    case Mode::kScene:
        return v1::DELIVERY_MODE_SCENE;
    case Mode::kWarp:
        return v1::DELIVERY_MODE_WARP;
    }
    return v1::DELIVERY_MODE_UNSPECIFIED;
}

v1::PlaneSet to_proto(PlaneWish planes) {
    switch (planes) {
    case PlaneWish::kWithGBuffer:
        return v1::PLANE_SET_WITH_G_BUFFER;
    case PlaneWish::kIllumination:
        return v1::PLANE_SET_ILLUMINATION;
    case PlaneWish::kTotalLight:
        return v1::PLANE_SET_TOTAL_LIGHT;
    }
    return v1::PLANE_SET_UNSPECIFIED;
}

/// Planes for which `Wish::codecs` holds.
bool is_picture(v1::PlaneSemantic semantic) {
    return semantic == v1::PLANE_SEMANTIC_COLOUR || semantic == v1::PLANE_SEMANTIC_DIFFUSE ||
           semantic == v1::PLANE_SEMANTIC_SPECULAR || semantic == v1::PLANE_SEMANTIC_TOTAL_LIGHT ||
           semantic == v1::PLANE_SEMANTIC_RESIDUAL_COLOUR;
}

void add_codecs(v1::Configure& message, const Wish& wish, v1::PlaneSemantic semantic) {
    v1::CodecPreference& preference = *message.add_codecs();
    preference.set_semantic(semantic);
    preference.set_quality(wish.quality);
    for (const codec::CodecId codec : wish.codecs) {
        preference.add_codecs(wire::to_proto(codec));
    }
}

void add_light_codecs(v1::Configure& message, const Wish& wish) {
    if (wish.planes == PlaneWish::kTotalLight) {
        add_codecs(message, wish, v1::PLANE_SEMANTIC_TOTAL_LIGHT);
    } else {
        add_codecs(message, wish, v1::PLANE_SEMANTIC_DIFFUSE);
        add_codecs(message, wish, v1::PLANE_SEMANTIC_SPECULAR);
    }
}

void add_formats(v1::Configure& message, const Wish& wish) {
    if (wish.has_coarse_normals && wish.planes == PlaneWish::kWithGBuffer) {
        v1::CodecPreference& preference = *message.add_codecs();
        preference.set_semantic(v1::PLANE_SEMANTIC_NORMAL);
        preference.add_formats(v1::PLANE_FORMAT_OCT2X8);
        preference.add_formats(v1::PLANE_FORMAT_OCT2X16); // of servers or recordings that do not have the other
    }
}

void add_adaptation(v1::Configure& message, const AdaptationWish& wish) {
    v1::Adaptation& bounds = *message.mutable_adaptation();
    if (wish.allows_jpeg) {
        bounds.add_codecs(v1::CODEC_JPEG);
    }
    bounds.set_min_quality(wish.min_quality);
    bounds.set_min_frames_per_second(wish.min_frames_per_second);
    bounds.set_min_view_height_px(wish.min_view_height_px);
    bounds.set_min_rows(wish.min_rows);
    bounds.set_min_cols(wish.min_cols);
    if (wish.allows_scene) {
        bounds.add_modes(v1::DELIVERY_MODE_SCENE);
    }
    bounds.set_max_queue_delay_ms(wish.max_queue_delay_ms);
}

/// `wish` as it is when everything that a server may change by itself is what it chose, within the bounds. Then a
/// Configured that has adapted is checked like an answer.
Wish adapted_wish(const v1::Configured& message, const Wish& wish) {
    const AdaptationWish& bounds = *wish.adaptation;
    Wish adapted = wish;
    if (bounds.allows_jpeg) {
        adapted.codecs.push_back(codec::CodecId::kJpeg);
    }
    if (bounds.allows_scene && message.mode() == v1::DELIVERY_MODE_SCENE && wish.mode == Mode::kViews) {
        adapted.mode = Mode::kScene;
        adapted.planes = PlaneWish::kIllumination;
        return adapted;
    }
    const v1::ViewSet& set = message.view_set();
    const auto lowered = [](std::uint32_t asked, std::uint32_t chosen, std::uint32_t least) {
        return least > 0 && chosen >= std::min(least, asked) && chosen <= asked ? chosen : asked;
    };
    adapted.rows = lowered(wish.rows, set.grid().rows(), bounds.min_rows);
    adapted.cols = lowered(wish.cols, set.grid().cols(), bounds.min_cols);
    if (wish.height_px != 0 && bounds.min_view_height_px != 0) {
        adapted.height_px = lowered(wish.height_px, set.height_px(), bounds.min_view_height_px);
        adapted.width_px = lowered(wish.width_px, set.width_px(), 1);
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

/// Why a server may not send planes in the codecs that it chose, or nothing.
std::optional<std::string> codec_problem(const v1::Configured& message, const Wish& wish) {
    for (const v1::PlaneHeader& plane : message.planes()) {
        const auto codec = wire::from_proto(plane.codec());
        const bool is_wanted =
            codec && (is_picture(plane.semantic())
                          ? std::find(wish.codecs.begin(), wish.codecs.end(), *codec) != wish.codecs.end()
                          : !codec::is_lossy(*codec));
        if (!is_wanted) {
            return "Configured: a codec that was not asked for";
        }
    }
    return std::nullopt;
}

std::optional<std::string> view_set_problem(const wire::ViewSet& set, const Wish& wish) {
    if (set.grid.rows != wish.rows || set.grid.cols != wish.cols || set.grid.anchor != wish.anchor) {
        return "Configured: another grid than asked for";
    }
    if (wish.width_px != 0 && (set.width_px != wish.width_px || set.height_px != wish.height_px)) {
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

/// Of a source frame; none of views.
Decoded<std::vector<PlaneBound>> plane_bounds(const v1::Configured& message, Mode mode) {
    std::vector<PlaneBound> bounds;
    if (mode == Mode::kViews) {
        return bounds;
    }
    for (const v1::PlaneHeader& plane : message.planes()) {
        const std::optional<PlaneBound> bound = plane_bound(plane);
        if (!bound) {
            return decode_error("Configured: a plane of unknown meaning or format, or a size outside 1 … 16384");
        }
        bounds.push_back(*bound);
    }
    return bounds;
}

/// Sizes in Configured are upper bounds; the assembler checks frames against what follows from them.
Decoded<wire::FrameLimits> frame_limits(const std::vector<PlaneBound>& planes, const wire::ViewSet& set, Mode mode) {
    wire::FrameLimits limits;
    limits.max_width_px = set.width_px;
    limits.max_height_px = set.height_px;
    limits.max_frame_bytes = plane_bytes(PlaneFormat::kRgb8, set.width_px, set.height_px) * set.grid.view_count();
    if (mode != Mode::kViews) {
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

std::optional<std::string> source_problem(const SourceFrame& frame, const wire::ViewSet& set, Mode mode) {
    const auto lacks = [&](PlaneSemantic semantic) { return frame.find(semantic) == nullptr; };
    const bool lacks_light = lacks(PlaneSemantic::kTotalLight) &&
                             (lacks(PlaneSemantic::kDiffuse) || lacks(PlaneSemantic::kSpecular));
    if (mode == Mode::kScene && lacks_light) {
        return "frame without illumination planes";
    }
    if (mode == Mode::kWarp && (lacks(PlaneSemantic::kColour) || lacks(PlaneSemantic::kInverseDepth))) {
        return "frame without colour and inverse depth";
    }
    const Camera& source = frame.header.source;
    if (set.height_px > source.height_px || set.width_px > source.width_px) {
        return "source smaller than the views";
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

v1::Configure to_configure(const Wish& wish, std::uint32_t request_id) {
    v1::Configure message;
    message.set_request_id(request_id);
    message.set_channel(wish.channel);
    message.add_modes(to_proto(wish.mode));
    v1::Grid& grid = *message.mutable_grid();
    grid.set_rows(wish.rows);
    grid.set_cols(wish.cols);
    grid.set_anchor(wish.anchor == Anchor::kCentre ? v1::ANCHOR_CENTRE : v1::ANCHOR_LATTICE);
    if (wish.spacing_m) {
        grid.set_spacing_x_m(*wish.spacing_m);
        grid.set_spacing_y_m(*wish.spacing_m);
    }
    if (wish.convergence_m) {
        grid.set_convergence_m(*wish.convergence_m);
    }
    message.set_view_width_px(wish.width_px);
    message.set_view_height_px(wish.height_px);
    message.set_fovy_rad(wish.fovy_rad);
    message.set_planes(to_proto(wish.planes));
    if (wish.mode == Mode::kScene) {
        add_light_codecs(message, wish);
        add_formats(message, wish);
    } else {
        add_codecs(message, wish, v1::PLANE_SEMANTIC_COLOUR);
    }
    if (wish.mode == Mode::kWarp && wish.has_residual) {
        add_codecs(message, wish, v1::PLANE_SEMANTIC_RESIDUAL_COLOUR);
        message.add_warp_planes(v1::WARP_PLANE_RESIDUAL);
    }
    message.set_max_frames_per_second(wish.max_frames_per_second);
    message.set_keeps_key_frames(true);
    if (wish.adaptation) {
        add_adaptation(message, *wish.adaptation);
    }
    return message;
}

Decoded<Agreement> from_configured(const v1::Configured& message, const Wish& asked) {
    if (message.has_adapted() && !asked.adaptation) {
        return decode_error("Configured: adapted, which was not asked for");
    }
    const Wish wish = message.has_adapted() ? adapted_wish(message, asked) : asked;
    Agreement agreement;
    agreement.epoch = message.epoch();
    agreement.channel = message.channel();
    agreement.mode = wish.mode;
    if (message.mode() != to_proto(wish.mode)) {
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
    if (const auto problem = view_set_problem(*set, wish)) {
        return decode_error(*problem);
    }
    if (const auto problem = codec_problem(message, wish)) {
        return decode_error(*problem);
    }
    Decoded<std::vector<PlaneBound>> planes = plane_bounds(message, wish.mode);
    if (!planes) {
        return tl::unexpected(planes.error());
    }
    agreement.planes = std::move(*planes);
    const Decoded<wire::FrameLimits> limits = frame_limits(agreement.planes, *set, wish.mode);
    if (!limits) {
        return tl::unexpected(limits.error());
    }
    agreement.limits = *limits;
    agreement.wish = wish;
    agreement.adapted = message.has_adapted() ? std::optional(from_proto(message.adapted())) : std::nullopt;
    const float rate = message.frames_per_second();
    agreement.frames_per_second = is_rate_bound(rate) ? rate : 0.0F;
    return agreement;
}

std::optional<std::string> frame_problem(const wire::ReceivedFrame& frame, const Agreement& agreement) {
    const auto* views = std::get_if<wire::ReceivedViews>(&frame.content);
    if ((views != nullptr) != (agreement.mode == Mode::kViews)) {
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
