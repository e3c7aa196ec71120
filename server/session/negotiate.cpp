// SPDX-License-Identifier: Apache-2.0
#include "server/session/negotiate.h"

#include "core/lightfield/frame_rate.h"
#include "server/session/quality_rungs.h"
#include "server/session/recorded.h"
#include "server/session/wanted_planes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace fieldcast::session {

namespace {

template <class T> using Chosen = tl::expected<T, Refusal>;

tl::unexpected<Refusal> refuse(v1::RefusalReason reason, std::string field, std::string message) {
    return tl::unexpected(Refusal{.reason = reason, .field = std::move(field), .message = std::move(message)});
}

tl::unexpected<Refusal> invalid(std::string field, std::string message) {
    return refuse(v1::REFUSAL_REASON_INVALID, std::move(field), std::move(message));
}

std::string text(float number) {
    std::ostringstream stream;
    stream << number;
    return stream.str();
}

Chosen<std::shared_ptr<feed::Feed>> choose_channel(const std::string& wanted, Channels channels) {
    std::string names;
    for (const auto& channel : channels) {
        if (wanted.empty() || channel->info().name == wanted) {
            return channel;
        }
        names += (names.empty() ? "" : ", ") + channel->info().name;
    }
    const std::string asked = wanted.size() <= feed::kMaxChannelNameBytes ? " '" + wanted + "'" : "";
    return refuse(v1::REFUSAL_REASON_NOT_FOUND, "channel", "there is no channel" + asked + "; there are: " + names);
}

bool offers(const feed::ChannelInfo& channel, DeliveryMode mode) {
    return !row_of(mode).needs_one_source || channel.source_count == 1;
}

/// "views, scene; warp needs one source, it has 3".
std::string offered_modes(const feed::ChannelInfo& channel) {
    std::string offered;
    std::string missing;
    for (const DeliveryMode mode : kAll<DeliveryMode>) {
        if (offers(channel, mode)) {
            offered += (offered.empty() ? "" : ", ") + std::string(word_of(mode));
        } else {
            missing += "; " + std::string(word_of(mode)) + " needs one source, it has " +
                       std::to_string(channel.source_count);
        }
    }
    return offered + missing;
}

Chosen<DeliveryMode> choose_mode(const v1::Configure& wanted, const feed::ChannelInfo& channel) {
    if (wanted.modes().empty()) {
        return DeliveryMode::kViews;
    }
    std::string asked;
    for (const int number : wanted.modes()) {
        const auto mode = wire::from_proto(static_cast<v1::DeliveryMode>(number));
        if (mode && offers(channel, *mode)) {
            return *mode;
        }
        if (asked.size() < 256) {
            asked += (asked.empty() ? "" : ", ") + (mode ? std::string(word_of(*mode)) : std::to_string(number));
        }
    }
    return refuse(v1::REFUSAL_REASON_UNSUPPORTED, "modes",
                  "channel '" + channel.name + "' does not offer mode " + asked + "; it offers " +
                      offered_modes(channel));
}

Chosen<ViewGrid> choose_grid(const v1::Configure& wanted, const feed::ChannelInfo& channel) {
    if (!wanted.has_grid()) {
        return channel.largest_grid;
    }
    const v1::Grid& grid = wanted.grid();
    for (const auto& [field, count] : {std::pair("grid.rows", grid.rows()), std::pair("grid.cols", grid.cols())}) {
        if (count == 0 || count > kMaxViews) {
            return invalid(field, std::to_string(count) + " asked, 1 to " + std::to_string(kMaxViews) + " allowed");
        }
    }
    const auto is_length = [](float metres) { return std::isfinite(metres) && metres >= 0.0F; };
    for (const auto& [field, spacing] :
         {std::pair("grid.spacing_x_m", grid.spacing_x_m()), std::pair("grid.spacing_y_m", grid.spacing_y_m())}) {
        if (!is_length(spacing)) {
            return invalid(field, text(spacing) + " m asked, finite and not negative allowed");
        }
    }
    if (std::isnan(grid.convergence_m()) || grid.convergence_m() < 0.0F) {
        return invalid("grid.convergence_m", text(grid.convergence_m()) + " m asked, 0 or more allowed");
    }
    auto chosen = wire::from_proto(grid, channel.largest_grid.geometry);
    if (!chosen) {
        return invalid("grid", chosen.error().message);
    }
    return *chosen;
}

/// Width and height of a view, px; 0 in `wanted` means the source's.
Chosen<glm::uvec2> choose_size(const v1::Configure& wanted, const feed::ChannelInfo& channel) {
    const glm::uvec2 asked(wanted.view_width_px(), wanted.view_height_px());
    const glm::uvec2 source(channel.source_width_px, channel.source_height_px);
    if (asked == glm::uvec2(0)) {
        return source;
    }
    const std::string range = " px asked, 1 to ";
    if (asked.x == 0 || asked.x > source.x) {
        return invalid("view_width_px",
                       std::to_string(asked.x) + range + std::to_string(source.x) + " (the source's) allowed");
    }
    if (asked.y == 0 || asked.y > source.y) {
        return invalid("view_height_px",
                       std::to_string(asked.y) + range + std::to_string(source.y) + " (the source's) allowed");
    }
    return asked;
}

Chosen<float> choose_fovy(const v1::Configure& wanted, const feed::ChannelInfo& channel) {
    const float asked = wanted.fovy_rad();
    if (asked == 0.0F) {
        return channel.fovy_rad;
    }
    constexpr float kRounding = 1.0F + 1e-5F; // a client may have computed the source's field of view from degrees
    if (!(asked > 0.0F) || !(asked <= channel.fovy_rad * kRounding)) {
        return invalid("fovy_rad", text(asked) + " rad asked, more than 0 and at most " + text(channel.fovy_rad) +
                                       " (the source's) allowed");
    }
    return std::min(asked, channel.fovy_rad);
}

Chosen<wire::ViewSet> choose_view_set(const v1::Configure& wanted, const feed::ChannelInfo& channel,
                                      DeliveryMode mode, const Limits& limits) {
    const auto grid = choose_grid(wanted, channel);
    if (!grid) {
        return tl::unexpected(grid.error());
    }
    const auto size = choose_size(wanted, channel);
    if (!size) {
        return tl::unexpected(size.error());
    }
    const auto fovy = choose_fovy(wanted, channel);
    if (!fovy) {
        return tl::unexpected(fovy.error());
    }
    const std::uint64_t pixels = static_cast<std::uint64_t>(grid->view_count()) * size->x * size->y;
    if (!is_made_by_client(mode) && pixels > limits.max_view_set_pixels) {
        return invalid("grid", std::to_string(pixels) + " pixels in all views asked, at most " +
                                   std::to_string(limits.max_view_set_pixels) + " allowed");
    }
    return wire::ViewSet{.grid = *grid, .width_px = size->x, .height_px = size->y, .fovy_rad = *fovy};
}

/// The first wanted format that `semantic` can be sent in; empty: the usual one.
Chosen<std::optional<PlaneFormat>> choose_format(const v1::Configure& wanted, PlaneSemantic semantic) {
    const v1::CodecPreference* const preference = find_preference(wanted, semantic);
    if (preference == nullptr || preference->formats().empty()) {
        return std::nullopt;
    }
    const PlaneFormat usual = usual_format(semantic);
    for (const int number : preference->formats()) {
        const auto format = wire::from_proto(static_cast<v1::PlaneFormat>(number));
        if (format && may_have_format(semantic, *format)) {
            return format == usual ? std::nullopt : format;
        }
    }
    return refuse(v1::REFUSAL_REASON_UNSUPPORTED, "codecs",
                  "no format asked for plane " + std::string(word_of(semantic)) +
                      " is supported; " + std::string(word_of(usual)) + " is");
}

/// The quality to send. Recordings offer only their recorded qualities; channels that encode round to kQualityRungs.
std::uint8_t choose_quality(std::uint32_t asked, const feed::ChannelInfo& channel) {
    const bool is_recorded = !channel.recorded.empty() && asked != 0;
    return is_recorded ? static_cast<std::uint8_t>(asked) : quality_rung(asked, channel.lossy_quality);
}

/// "raw or zstd".
std::string codecs_for_every_plane() {
    std::vector<Codec> codecs(kAll<Codec>.begin(), kAll<Codec>.end());
    std::erase_if(codecs, [](Codec codec) { return !row_of(codec).only.empty(); });
    return alternatives<Codec>(codecs);
}

/// The first wanted codec that the server supports for `semantic`, at the wanted quality.
Chosen<codec::Encoding> choose_encoding(const v1::Configure& wanted, PlaneSemantic semantic,
                                        const feed::ChannelInfo& channel) {
    const v1::CodecPreference* const preference = find_preference(wanted, semantic);
    if (preference == nullptr || preference->codecs().empty()) {
        return codec::Encoding{};
    }
    if (preference->quality() > kMaxQuality) {
        return invalid("codecs", "quality " + std::to_string(preference->quality()) + " asked, 1 to " +
                                     std::to_string(kMaxQuality) + " allowed, 0: the server's choice");
    }
    for (const int number : preference->codecs()) {
        const auto codec = wire::from_proto(static_cast<v1::Codec>(number));
        if (codec && carries(*codec, usual_format(semantic))) {
            const std::uint8_t quality = choose_quality(preference->quality(), channel);
            return codec::Encoding{*codec, is_lossy(*codec) ? quality : std::uint8_t{0}};
        }
    }
    return refuse(v1::REFUSAL_REASON_UNSUPPORTED, "codecs",
                  "no codec asked for plane " + std::string(word_of(semantic)) +
                      " is supported; every plane can be sent as " + codecs_for_every_plane());
}

Chosen<feed::Selection> choose_planes(const v1::Configure& wanted, const feed::ChannelInfo& channel,
                                 std::span<const PlaneSemantic> semantics) {
    feed::PlaneSelection selection;
    for (const PlaneSemantic semantic : semantics) {
        const auto encoding = choose_encoding(wanted, semantic, channel);
        if (!encoding) {
            return tl::unexpected(encoding.error());
        }
        const auto format = choose_format(wanted, semantic);
        if (!format) {
            return tl::unexpected(format.error());
        }
        selection.choices.push_back({.semantic = semantic, .encoding = *encoding, .format = *format});
    }
    return selection;
}

Chosen<feed::Selection> choose_selection(const v1::Configure& wanted, const feed::ChannelInfo& channel,
                                         DeliveryMode mode, const wire::ViewSet& set) {
    if (is_made_by_client(mode)) {
        return choose_planes(wanted, channel, asked_planes(wanted, mode));
    }
    const auto encoding = choose_encoding(wanted, PlaneSemantic::kColour, channel);
    if (!encoding) {
        return tl::unexpected(encoding.error());
    }
    return feed::ViewSelection{.format = {.geometry = set.grid.geometry,
                                          .fovy_rad = set.fovy_rad,
                                          .width_px = set.width_px,
                                          .height_px = set.height_px,
                                          .encoding = *encoding},
                               .grid = set.grid};
}

Chosen<float> choose_rate(const v1::Configure& wanted, const feed::ChannelInfo& channel) {
    const float asked = wanted.max_frames_per_second();
    const float least = wanted.adaptation().min_frames_per_second();
    for (const auto& [field, rate] :
         {std::pair("max_frames_per_second", asked), std::pair("adaptation.min_frames_per_second", least)}) {
        if (!is_rate_bound(rate)) {
            return invalid(field, text(rate) + " asked, 0 or a finite number from " + text(kMinFramesPerSecond) +
                                      " on allowed");
        }
    }
    return asked == 0.0F ? channel.frames_per_second : std::min(asked, channel.frames_per_second);
}

Chosen<std::uint32_t> choose_chunk_bytes(const v1::Configure& wanted, const Limits& limits) {
    const std::uint32_t asked = wanted.chunk_bytes();
    if (asked != 0 && (asked < wire::kMinChunkBytes || asked > wire::kMaxChunkBytes)) {
        return invalid("chunk_bytes", std::to_string(asked) + " asked, " + std::to_string(wire::kMinChunkBytes) +
                                          " to " + std::to_string(wire::kMaxChunkBytes) + " allowed");
    }
    return std::min(asked == 0 ? wire::kDefaultChunkBytes : asked, limits.max_chunk_bytes);
}

} // namespace

tl::expected<Configuration, Refusal> negotiate(const v1::Configure& asked, Channels channels, const Limits& limits) {
    const auto channel = choose_channel(asked.channel(), channels);
    if (!channel) {
        return tl::unexpected(channel.error());
    }
    const feed::ChannelInfo& info = (*channel)->info();
    const v1::Configure wanted = narrowed(asked, info);
    const auto mode = choose_mode(wanted, info);
    if (!mode) {
        return tl::unexpected(mode.error());
    }
    const auto view_set = choose_view_set(wanted, info, *mode, limits);
    if (!view_set) {
        return tl::unexpected(view_set.error());
    }
    auto selection = choose_selection(wanted, info, *mode, *view_set);
    if (!selection) {
        return tl::unexpected(selection.error());
    }
    if (auto problem = recorded_problem(*selection, info)) {
        return refuse(v1::REFUSAL_REASON_UNSUPPORTED, std::move(problem->field), std::move(problem->message));
    }
    const auto rate = choose_rate(wanted, info);
    if (!rate) {
        return tl::unexpected(rate.error());
    }
    const auto chunk_bytes = choose_chunk_bytes(wanted, limits);
    if (!chunk_bytes) {
        return tl::unexpected(chunk_bytes.error());
    }
    const std::uint64_t bytes =
        wanted.max_bytes_in_flight() == 0 ? limits.max_bytes_in_flight : wanted.max_bytes_in_flight();
    return Configuration{.feed = *channel,
                         .mode = *mode,
                         .view_set = *view_set,
                         .selection = std::move(*selection),
                         .frames_per_second = *rate,
                         .max_bytes_in_flight = std::min(bytes, limits.max_bytes_in_flight),
                         .chunk_bytes = *chunk_bytes,
                         .keeps_key_frames = wanted.keeps_key_frames()};
}

} // namespace fieldcast::session
