// SPDX-License-Identifier: Apache-2.0
#include "server/recording/channel_facts.h"

#include "core/lightfield/frame_rate.h"
#include "core/wire/convert.h"

#include "fieldcast/v1/recording.pb.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fieldcast::recording {

namespace {

constexpr std::size_t kMaxCameraBytes = 256;
constexpr int kMaxForms = 64;
constexpr int kMaxPlanes = 16;

void encoding_to_proto(const codec::Encoding& encoding, v1::RecordedEncoding& message) {
    message.set_codec(wire::to_proto(encoding.codec));
    message.set_quality(encoding.quality);
}

void form_to_proto(const feed::PlaneSelection& selection, v1::RecordedForm& message) {
    for (const wire::PlaneChoice& choice : selection.choices) {
        v1::RecordedPlane& plane = *message.mutable_planes()->add_planes();
        plane.set_semantic(wire::to_proto(choice.semantic));
        encoding_to_proto(choice.encoding, *plane.mutable_encoding());
    }
}

void form_to_proto(const feed::ViewSelection& selection, v1::RecordedForm& message) {
    const wire::ViewFormat& format = selection.format;
    wire::to_proto(wire::ViewSet{selection.grid, format.width_px, format.height_px, format.fovy_rad},
                   *message.mutable_views()->mutable_view_set());
    encoding_to_proto(format.encoding, *message.mutable_views()->mutable_encoding());
}

Decoded<codec::Encoding> encoding_from_proto(const v1::RecordedEncoding& message, PlaneSemantic semantic) {
    const auto codec = wire::from_proto(message.codec());
    if (!codec || !carries(*codec, usual_format(semantic))) {
        return decode_error("form: codec " + std::to_string(message.codec()) + " is unknown or does not fit its plane");
    }
    const bool is_right = is_lossy(*codec) ? message.quality() >= 1 && message.quality() <= kMaxQuality
                                                  : message.quality() == 0;
    if (!is_right) {
        return decode_error("form: quality " + std::to_string(message.quality()) + " does not fit the codec");
    }
    return codec::Encoding{.codec = *codec, .quality = static_cast<std::uint8_t>(message.quality())};
}

Decoded<feed::Selection> selection_from_proto(const v1::RecordedPlanes& message) {
    feed::PlaneSelection selection;
    if (message.planes().empty() || message.planes_size() > kMaxPlanes) {
        return decode_error("form: " + std::to_string(message.planes_size()) + " planes, 1 to 16 allowed");
    }
    for (const v1::RecordedPlane& plane : message.planes()) {
        const auto semantic = wire::from_proto(plane.semantic());
        if (!semantic) {
            return decode_error("form: unknown plane " + std::to_string(plane.semantic()));
        }
        const auto encoding = encoding_from_proto(plane.encoding(), *semantic);
        if (!encoding) {
            return tl::unexpected(encoding.error());
        }
        selection.choices.push_back({.semantic = *semantic, .encoding = *encoding});
    }
    return selection;
}

Decoded<feed::Selection> selection_from_proto(const v1::RecordedViews& message) {
    const auto set = wire::from_proto(message.view_set());
    if (!set) {
        return tl::unexpected(set.error());
    }
    const auto encoding = encoding_from_proto(message.encoding(), PlaneSemantic::kColour);
    if (!encoding) {
        return tl::unexpected(encoding.error());
    }
    return feed::ViewSelection{.format = {.geometry = set->grid.geometry,
                                      .fovy_rad = set->fovy_rad,
                                      .width_px = set->width_px,
                                      .height_px = set->height_px,
                                      .encoding = *encoding},
                           .grid = set->grid};
}

Decoded<feed::Selection> selection_from_proto(const v1::RecordedForm& message) {
    switch (message.form_case()) {
    case v1::RecordedForm::kPlanes:
        return selection_from_proto(message.planes());
    case v1::RecordedForm::kViews:
        return selection_from_proto(message.views());
    case v1::RecordedForm::FORM_NOT_SET:
        break;
    }
    return decode_error("form: it has neither planes nor views");
}

bool is_size(std::uint32_t px) {
    return px >= 1 && px <= kMaxPlaneSide;
}

/// Problem with a number or a name in `message`; null: none.
const char* problem_of(const v1::RecordedChannel& message) {
    if (message.name().empty() || message.name().size() > feed::kMaxChannelNameBytes) {
        return "channel: its name must have 1 to 64 bytes";
    }
    if (message.scene_hash().size() != sizeof(feed::ChannelInfo::scene_hash)) {
        return "channel: scene_hash must have 32 bytes";
    }
    if (!is_size(message.source_width_px()) || !is_size(message.source_height_px())) {
        return "channel: the source must have 1 to 16384 pixels per side";
    }
    if (message.source_count() < 1 || message.source_count() > kMaxSources) {
        return "channel: it must have 1 to 8 sources";
    }
    if (!(message.fovy_rad() > 0.0F && message.fovy_rad() < std::numbers::pi_v<float>)) {
        return "channel: fovy_rad must lie between 0 and pi";
    }
    if (!is_frame_rate(message.frames_per_second())) {
        return "channel: its rate must be 0.1 to 240 frames per second";
    }
    if (message.camera().size() > kMaxCameraBytes) {
        return "channel: the camera's name must have at most 256 bytes";
    }
    const bool has_forms = !message.forms().empty() && message.forms_size() <= kMaxForms;
    return has_forms ? nullptr : "channel: it must have 1 to 64 forms";
}

feed::ChannelInfo plain_facts(const v1::RecordedChannel& message) {
    feed::ChannelInfo info;
    info.name = message.name();
    std::ranges::transform(message.scene_hash(), info.scene_hash.begin(),
                           [](char byte) { return static_cast<std::uint8_t>(byte); });
    info.source_width_px = message.source_width_px();
    info.source_height_px = message.source_height_px();
    info.source_count = message.source_count();
    info.fovy_rad = message.fovy_rad();
    info.frames_per_second = message.frames_per_second();
    info.camera = message.camera();
    info.control = message.is_camera_animated() ? feed::CameraControl::kScripted : feed::CameraControl::kFixed;
    info.max_view_pixels = std::numeric_limits<std::uint64_t>::max(); // nothing is rendered
    return info;
}

} // namespace

Bytes to_bytes(const feed::ChannelInfo& info) {
    v1::RecordedChannel message;
    message.set_name(info.name);
    message.set_scene_hash(info.scene_hash.data(), info.scene_hash.size());
    message.set_source_width_px(info.source_width_px);
    message.set_source_height_px(info.source_height_px);
    message.set_source_count(info.source_count);
    message.set_fovy_rad(info.fovy_rad);
    wire::to_proto(info.largest_grid, *message.mutable_largest_grid());
    message.set_frames_per_second(info.frames_per_second);
    wire::to_proto(info.guard_band, *message.mutable_guard_band());
    message.set_camera(info.camera);
    message.set_is_camera_animated(info.control != feed::CameraControl::kFixed);
    for (const feed::Selection& selection : info.recorded) {
        std::visit([&](const auto& kind) { form_to_proto(kind, *message.add_forms()); }, selection);
    }
    Bytes bytes(message.ByteSizeLong());
    message.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
    return bytes;
}

Decoded<feed::ChannelInfo> channel_from_bytes(std::span<const std::byte> bytes) {
    v1::RecordedChannel message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
        return decode_error("channel: these bytes are not a fieldcast.v1.RecordedChannel");
    }
    if (const char* const problem = problem_of(message)) {
        return decode_error(problem);
    }
    feed::ChannelInfo info = plain_facts(message);
    const auto grid = wire::from_proto(message.largest_grid(), LatticeGeometry{});
    const auto band = wire::from_proto(message.guard_band());
    if (!grid || !band) {
        return tl::unexpected(!grid ? grid.error() : band.error());
    }
    info.largest_grid = *grid;
    info.guard_band = *band;
    for (const v1::RecordedForm& form : message.forms()) {
        auto selection = selection_from_proto(form);
        if (!selection) {
            return tl::unexpected(selection.error());
        }
        info.recorded.push_back(std::move(*selection));
    }
    return info;
}

} // namespace fieldcast::recording
