// SPDX-License-Identifier: Apache-2.0
#include "server/session/agreement.h"

#include "server/feed/frame_interval.h"

#include <algorithm>

namespace fieldcast::session {

namespace {

/// Pixels of the views that the server makes for a client, per frame.
std::uint64_t made_pixels(const Configuration& configuration) {
    const wire::ViewSet& set = configuration.view_set;
    const bool makes_views = !is_made_by_client(configuration.mode);
    return makes_views ? static_cast<std::uint64_t>(set.grid.view_count()) * set.width_px * set.height_px : 0;
}

feed::CameraLoad load_of(const Configuration& configuration) {
    return {.frames_per_second = configuration.frames_per_second, .view_pixels = made_pixels(configuration)};
}

/// The client's frame rate cap; without one the channel sets the pace.
feed::Pace pace_of(const Configuration& configuration) {
    const bool is_capped = configuration.frames_per_second < configuration.feed->info().frames_per_second;
    return is_capped ? feed::Pace(feed::frame_interval(configuration.frames_per_second)) : feed::Pace();
}

Refusal exhausted(std::string field, std::string message) {
    return {.reason = v1::REFUSAL_REASON_EXHAUSTED, .field = std::move(field), .message = std::move(message)};
}

/// The field that a client can change when the channel's encoding budget is used up.
const char* budget_field(const Configuration& wanted) {
    return is_made_by_client(wanted.mode) ? "codecs" : "grid";
}

} // namespace

Agreement::Agreement(std::vector<std::shared_ptr<feed::Feed>> channels, const Limits& limits,
                     feed::FrameCallback on_frame, const PeerBudgets& budgets, bool may_steer)
    : channels_(std::move(channels)), limits_(limits), on_frame_(std::move(on_frame)), may_steer_(may_steer),
      pixels_(budgets.pixels), cameras_(budgets.cameras) {}

std::optional<Refusal> Agreement::change(const v1::Configure& wanted) {
    auto chosen = negotiate(wanted, channels_, limits_);
    std::optional<Refusal> refusal = chosen ? admit(*chosen) : std::optional(chosen.error());
    if (refusal) {
        return refusal;
    }
    configuration_ = std::move(*chosen);
    pace_ = pace_of(*configuration_);
    ++epoch_;
    return std::nullopt;
}

void Agreement::close() {
    subscription_.end();
    own_feed_.close();
    cameras_.resize(0);
    pixels_.resize(0);
}

std::optional<Refusal> Agreement::admit(Configuration& wanted) {
    if (is_frozen_) {
        return exhausted("", "the server is going away");
    }
    if (wanted.feed->opener() != nullptr && !may_steer_) {
        return Refusal{.reason = v1::REFUSAL_REASON_ROLE_TOO_LOW,
                       .field = "channel",
                       .message = "channel '" + wanted.feed->info().name +
                                  "' gives every client a camera to steer; that needs the role steer"};
    }
    const std::uint64_t old_pixels = configuration_ ? made_pixels(*configuration_) : 0;
    const std::uint64_t new_pixels = made_pixels(wanted);
    if (!pixels_.resize(std::max(old_pixels, new_pixels))) { // the larger one, until the outcome is known
        return exhausted("grid", std::to_string(new_pixels) + " pixels in all views asked; with those of the other " +
                                     "sessions of this peer they are more than the " +
                                     std::to_string(limits_.max_pixels_per_peer) + " that one peer may have");
    }
    auto problem = subscribe(wanted);
    pixels_.resize(problem ? old_pixels : new_pixels);
    return problem;
}

std::optional<Refusal> Agreement::subscribe(Configuration& wanted) {
    feed::OwnFeed opened;
    if (const auto opener = wanted.feed->opener()) {
        if (own_feed_.opener() == opener) {
            return change_own_feed(wanted);
        }
        auto own = open_own_feed(wanted);
        if (!own) {
            return std::move(own.error());
        }
        opened = std::move(*own);
        wanted.feed = opened.feed();
    }
    if (subscription_.feed() == wanted.feed) {
        auto problem = subscription_.change(wanted.selection, pace_of(wanted));
        return problem ? std::optional(exhausted(budget_field(wanted), std::move(*problem))) : std::nullopt;
    }
    auto subscription = feed::Feed::subscribe(wanted.feed, wanted.selection, on_frame_, pace_of(wanted));
    if (!subscription) {
        update_camera_share();
        return exhausted(budget_field(wanted), std::move(subscription.error()));
    }
    subscription_ = std::move(*subscription);
    own_feed_ = std::move(opened); // closes the previous own feed, whose subscription has just ended
    update_camera_share();
    return std::nullopt;
}

void Agreement::update_camera_share() {
    cameras_.resize(own_feed_.feed() != nullptr ? 1 : 0);
}

tl::expected<feed::OwnFeed, Refusal> Agreement::open_own_feed(const Configuration& wanted) {
    if (!cameras_.resize(1)) {
        return tl::unexpected(exhausted(
            "channel", "channel '" + wanted.feed->info().name + "' gives every client a camera; one peer may have " +
                           std::to_string(limits_.max_own_cameras_per_peer) + " of all " +
                           std::to_string(limits_.max_own_cameras) +
                           ", and the last are kept for peers that have none"));
    }
    auto own = wanted.feed->opener()->open(load_of(wanted), own_feed_.feed() != nullptr ? &own_feed_ : nullptr);
    if (!own) {
        update_camera_share();
        return tl::unexpected(exhausted("channel", std::move(own.error())));
    }
    return std::move(*own);
}

std::optional<Refusal> Agreement::change_own_feed(Configuration& wanted) {
    wanted.feed = own_feed_.feed();
    if (auto problem = subscription_.change(wanted.selection, pace_of(wanted))) {
        return exhausted(budget_field(wanted), std::move(*problem));
    }
    if (auto problem = own_feed_.change(load_of(wanted))) {
        subscription_.change(configuration_->selection, pace_); // cannot fail: this feed has no other subscriber
        return exhausted("channel", std::move(*problem));
    }
    return std::nullopt;
}

} // namespace fieldcast::session
