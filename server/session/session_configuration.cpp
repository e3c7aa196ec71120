// SPDX-License-Identifier: Apache-2.0
// How a session comes by its configuration, and changes it.
#include "server/feed/frame_interval.h"
#include "server/session/field_limits.h"
#include "server/session/session.h"

#include <algorithm>

namespace fieldcast::session {

namespace {

/// Pixels of the views that the server makes for a client.
std::uint64_t made_pixels(const Configuration& configuration) {
    const wire::ViewSet& set = configuration.view_set;
    const bool makes_views = !is_made_by_client(configuration.mode);
    return makes_views ? static_cast<std::uint64_t>(set.grid.view_count()) * set.width_px * set.height_px : 0;
}

feed::CameraLoad load_of(const Configuration& configuration) {
    return {.frames_per_second = configuration.frames_per_second, .view_pixels = made_pixels(configuration)};
}

/// A cap of the client; without one the channel sets the pace.
feed::Pace pace_of(const Configuration& configuration) {
    const bool is_capped = configuration.frames_per_second < configuration.feed->info().frames_per_second;
    return is_capped ? feed::Pace(feed::frame_interval(configuration.frames_per_second)) : feed::Pace();
}

Refusal exhausted(std::string field, std::string message) {
    return {.reason = v1::REFUSAL_REASON_EXHAUSTED, .field = std::move(field), .message = std::move(message)};
}

/// What a client changes about it when the channel encodes as much as it may.
const char* budget_field(const Configuration& wanted) {
    return is_made_by_client(wanted.mode) ? "codecs" : "grid";
}

} // namespace

void Session::handle(const v1::Configure& wanted, TimePoint now) {
    if (const auto oversized = oversized_field(wanted)) {
        return refuse(*oversized, wanted.request_id());
    }
    auto chosen = negotiate(wanted, channels_, limits_);
    std::optional<Refusal> refusal = chosen ? admit(*chosen) : std::optional(chosen.error());
    if (refusal) {
        return refuse(*refusal, wanted.request_id());
    }
    request_id_ = wanted.request_id();
    adapter_.configured(wanted, *chosen);
    begin_epoch(std::move(*chosen));
    steering_.move_to(configuration_->feed->steering(), now);
}

void Session::refuse(const Refusal& refusal, std::uint32_t request_id) {
    ++counts_.refusals;
    *answers_.emplace_back().mutable_refused() = to_message(refusal, request_id);
}

v1::Configured& Session::begin_epoch(Configuration chosen) {
    drop_old_configuration();
    configuration_ = std::move(chosen);
    credits_.configure(static_cast<double>(configuration_->frames_per_second), configuration_->max_bytes_in_flight);
    pace_ = pace_of(*configuration_);
    is_full_ = false; // the mailbox is empty
    has_room_since_ = {};
    subscription_.set_room({});
    set_key_frame(0);
    ++epoch_;
    v1::Configured& configured = *answers_.emplace_back().mutable_configured();
    configured = to_message(*configuration_, request_id_, epoch_, credits_.limit());
    return configured;
}

std::optional<Refusal> Session::admit(Configuration& wanted) {
    if (departure_ || cut_at_) {
        return exhausted("", "the server is going away");
    }
    if (wanted.feed->opener() != nullptr && !steering_.may_steer()) {
        return Refusal{.reason = v1::REFUSAL_REASON_ROLE_TOO_LOW,
                       .field = "channel",
                       .message = "channel '" + wanted.feed->info().name +
                                  "' gives every client a camera to steer; that " + "needs the role steer"};
    }
    const std::uint64_t old_pixels = configuration_ ? made_pixels(*configuration_) : 0;
    const std::uint64_t new_pixels = made_pixels(wanted);
    if (!pixels_.resize(std::max(old_pixels, new_pixels))) { // both, until it is known which of them it will be
        return exhausted("grid", std::to_string(new_pixels) + " pixels in all views asked; with those of the other " +
                                     "sessions of this peer they are more than the " +
                                     std::to_string(limits_.max_pixels_per_peer) + " that one peer may have");
    }
    auto problem = subscribe(wanted);
    pixels_.resize(problem ? old_pixels : new_pixels);
    return problem;
}

std::optional<Refusal> Session::subscribe(Configuration& wanted) {
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
        count_camera();
        return exhausted(budget_field(wanted), std::move(subscription.error()));
    }
    subscription_ = std::move(*subscription);
    own_feed_ = std::move(opened); // the one before closes, after its subscription has ended
    count_camera();
    return std::nullopt;
}

void Session::count_camera() {
    cameras_.resize(own_feed_.feed() != nullptr ? 1 : 0);
}

tl::expected<feed::OwnFeed, Refusal> Session::open_own_feed(const Configuration& wanted) {
    if (!cameras_.resize(1)) {
        return tl::unexpected(
            exhausted("channel", "channel '" + wanted.feed->info().name + "' gives every client a camera; one peer may have " +
                                 std::to_string(limits_.max_own_cameras_per_peer) + ", and the last of all " +
                                 std::to_string(limits_.max_own_cameras) + " go to peers that have none"));
    }
    auto own = wanted.feed->opener()->open(load_of(wanted), own_feed_.feed() != nullptr ? &own_feed_ : nullptr);
    if (!own) {
        count_camera();
        return tl::unexpected(exhausted("channel", std::move(own.error())));
    }
    return std::move(*own);
}

std::optional<Refusal> Session::change_own_feed(Configuration& wanted) {
    wanted.feed = own_feed_.feed();
    if (auto problem = subscription_.change(wanted.selection, pace_of(wanted))) {
        return exhausted(budget_field(wanted), std::move(*problem));
    }
    if (auto problem = own_feed_.change(load_of(wanted))) {
        subscription_.change(configuration_->selection, pace_); // fits: nobody else is there
        return exhausted("channel", std::move(*problem));
    }
    return std::nullopt;
}

void Session::drop_old_configuration() {
    if (sending_) {
        v1::FrameAborted& aborted = *answers_.emplace_back().mutable_frame_aborted();
        aborted.set_frame_id(sending_->frame.frame_id);
        aborted.set_epoch(epoch_);
        aborted.set_reason(v1::ABORT_REASON_RECONFIGURED);
        credits_.give_back({.epoch = epoch_, .frame_id = sending_->frame.frame_id});
        adapter_.aborted({.epoch = epoch_, .frame_id = sending_->frame.frame_id});
        timings_.aborted({.epoch = epoch_, .frame_id = sending_->frame.frame_id});
        bytes_.resize(credits_.bytes_in_flight());
        counts_.drops.add(DropReason::kReconfigured);
        sending_.reset();
    }
    if (mailbox_.take()) {
        counts_.drops.add(DropReason::kReconfigured);
    }
}

void Session::adapt(TimePoint now) {
    const bool is_leaving = departure_ || cut_at_;
    const auto change = is_leaving ? std::nullopt : adapter_.due(now);
    if (!change) {
        return;
    }
    auto chosen = negotiate(adapter_.configure(*change), channels_, limits_);
    if (!chosen || admit(*chosen)) { // such as no room for views of another size
        adapter_.refused();
        return;
    }
    *begin_epoch(std::move(*chosen)).mutable_adapted() = adapter_.to_message(*change);
    ++(change->reason == LevelReason::kRecovered ? counts_.adaptations.up : counts_.adaptations.down);
}

} // namespace fieldcast::session
