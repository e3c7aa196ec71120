// SPDX-License-Identifier: Apache-2.0
#include "server/session/recorded.h"

#include "core/wire/convert.h"
#include "server/session/wanted_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fieldcast::session {

namespace {

constexpr std::array kUnasked{v1::CODEC_ZSTD_FILTERED, v1::CODEC_RAW}; // for clients that name no codecs

bool is_format_wanted(const wire::PlaneChoice& recorded, const v1::CodecPreference& preference) {
    return preference.formats().empty() ||
           std::ranges::find(preference.formats(), wire::to_proto(wire::format_of(recorded))) !=
               preference.formats().end();
}

/// Position of the recorded codec in the client's list, 0 first; empty: the client does not want this encoding.
std::optional<std::size_t> rank_of(const wire::PlaneChoice& recorded, const v1::Configure& wanted) {
    const auto place_in = [&](const auto& codecs) -> std::optional<std::size_t> {
        const auto found = std::ranges::find(codecs, wire::to_proto(recorded.encoding.codec));
        return found == codecs.end() ? std::nullopt : std::optional<std::size_t>(found - codecs.begin());
    };
    const v1::CodecPreference* const preference = find_preference(wanted, recorded.semantic);
    if (preference != nullptr && !is_format_wanted(recorded, *preference)) {
        return std::nullopt;
    }
    if (preference == nullptr || preference->codecs().empty()) {
        return place_in(kUnasked);
    }
    const bool has_quality = preference->quality() == 0 || !is_lossy(recorded.encoding.codec) ||
                             preference->quality() == recorded.encoding.quality;
    return has_quality ? place_in(preference->codecs()) : std::nullopt;
}

void ask_for(const wire::PlaneChoice& recorded, v1::Configure& wanted) {
    const auto semantic = wire::to_proto(recorded.semantic);
    auto preference = std::ranges::find(*wanted.mutable_codecs(), semantic,
                                        [](const v1::CodecPreference& p) { return p.semantic(); });
    v1::CodecPreference& only =
        preference == wanted.mutable_codecs()->end() ? *wanted.add_codecs() : *preference;
    only.set_semantic(semantic);
    only.clear_codecs();
    only.add_codecs(wire::to_proto(recorded.encoding.codec));
    only.set_quality(recorded.encoding.quality);
    only.clear_formats();
    only.add_formats(wire::to_proto(wire::format_of(recorded)));
}

wire::PlaneChoice colour_of(const feed::ViewSelection& recorded) {
    return {.semantic = PlaneSemantic::kColour, .encoding = recorded.format.encoding};
}

/// Whether size, field of view and grid in `wanted` match the recorded views.
bool fits(const v1::Configure& wanted, const feed::ViewSelection& recorded, const feed::ChannelInfo& channel) {
    const wire::ViewFormat& format = recorded.format;
    const bool has_size = wanted.view_width_px() == 0 && wanted.view_height_px() == 0;
    if (!has_size && (wanted.view_width_px() != format.width_px || wanted.view_height_px() != format.height_px)) {
        return false;
    }
    constexpr float kRounding = 1e-4F; // a client may have computed the field of view from degrees
    const float fovy = wanted.fovy_rad();
    if (fovy != 0.0F && !(std::abs(fovy - format.fovy_rad) <= kRounding * format.fovy_rad)) {
        return false;
    }
    if (!wanted.has_grid()) {
        return true;
    }
    const auto grid = wire::from_proto(wanted.grid(), channel.largest_grid.geometry);
    return grid && grid->geometry == format.geometry &&
           feed::covers(channel.recorded, feed::ViewSelection{.format = format, .grid = *grid});
}

bool narrow_views(v1::Configure& wanted, const feed::ChannelInfo& channel) {
    const feed::ViewSelection* best = nullptr;
    std::optional<std::size_t> best_rank;
    for (const feed::Selection& selection : channel.recorded) {
        const auto* const recorded = std::get_if<feed::ViewSelection>(&selection);
        if (recorded == nullptr || !fits(wanted, *recorded, channel)) {
            continue;
        }
        const auto rank = rank_of(colour_of(*recorded), wanted);
        if (rank && (!best_rank || *rank < *best_rank)) {
            best = recorded;
            best_rank = rank;
        }
    }
    if (best == nullptr) {
        return false;
    }
    if (!wanted.has_grid()) {
        wire::to_proto(best->grid, *wanted.mutable_grid());
    }
    wanted.set_view_width_px(best->format.width_px);
    wanted.set_view_height_px(best->format.height_px);
    wanted.set_fovy_rad(best->format.fovy_rad);
    ask_for(colour_of(*best), wanted);
    return true;
}

/// For modes whose clients make their own views. False: no recorded form has the wanted planes.
bool narrow_planes(v1::Configure& wanted, const feed::ChannelInfo& channel, DeliveryMode mode) {
    const std::vector<PlaneSemantic> asked = asked_planes(wanted, mode);
    const auto is_asked = [&](const wire::PlaneChoice& choice) {
        return std::ranges::find(asked, choice.semantic) != asked.end();
    };
    for (const feed::Selection& selection : channel.recorded) {
        const auto* const recorded = std::get_if<feed::PlaneSelection>(&selection);
        if (recorded == nullptr || std::ranges::none_of(recorded->choices, is_asked) ||
            !std::ranges::all_of(recorded->choices, [&](const wire::PlaneChoice& choice) {
                return !is_asked(choice) || rank_of(choice, wanted).has_value();
            })) {
            continue;
        }
        for (const wire::PlaneChoice& choice : recorded->choices) {
            if (is_asked(choice)) {
                ask_for(choice, wanted);
            }
        }
        return true;
    }
    return false;
}

bool narrow(v1::Configure& wanted, const feed::ChannelInfo& channel, DeliveryMode mode) {
    return is_made_by_client(mode) ? narrow_planes(wanted, channel, mode) : narrow_views(wanted, channel);
}

} // namespace

v1::Configure narrowed(v1::Configure wanted, const feed::ChannelInfo& channel) {
    if (channel.recorded.empty()) {
        return wanted;
    }
    const std::vector<int> modes = wanted.modes().empty()
                                       ? std::vector<int>{v1::DELIVERY_MODE_VIEWS}
                                       : std::vector<int>(wanted.modes().begin(), wanted.modes().end());
    for (const int number : modes) {
        const auto mode = wire::from_proto(static_cast<v1::DeliveryMode>(number));
        if (mode && narrow(wanted, channel, *mode)) {
            wanted.clear_modes();
            wanted.add_modes(wire::to_proto(*mode));
            break;
        }
    }
    return wanted;
}

std::optional<RecordedProblem> recorded_problem(const feed::Selection& selection, const feed::ChannelInfo& channel) {
    if (channel.recorded.empty() || feed::covers(channel.recorded, selection)) {
        return std::nullopt;
    }
    std::string recorded;
    bool has_mode = false;
    for (const feed::Selection& one : channel.recorded) {
        recorded += (recorded.empty() ? "" : "; ") + feed::to_text(one);
        has_mode = has_mode || one.index() == selection.index();
    }
    const bool wants_planes = std::holds_alternative<feed::PlaneSelection>(selection);
    return RecordedProblem{.field = !has_mode ? "modes" : wants_planes ? "planes" : "grid",
                           .message = "channel '" + channel.name + "' is a recording without " +
                                      feed::to_text(selection) + "; recorded: " + recorded};
}

} // namespace fieldcast::session
