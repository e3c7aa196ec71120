// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/budget.h"
#include "server/session/negotiate.h"

#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

namespace fieldcast::session {

/// The configuration that one client was granted, and the resources held for it: a subscription, a camera of its own
/// where the channel has one per client, and shares of its peer's budgets. Not thread-safe.
class Agreement {
public:
    /// `channels` must not be empty. `on_frame` may be called by any thread. `may_steer`: channels that give every
    /// client a camera are open to it.
    Agreement(std::vector<std::shared_ptr<feed::Feed>> channels, const Limits& limits, feed::FrameCallback on_frame,
              const PeerBudgets& budgets, bool may_steer);

    /// Puts the configuration that `wanted` asks for in force, under the next epoch. On refusal nothing changes.
    std::optional<Refusal> change(const v1::Configure& wanted);

    /// Refuses every further change: the server is going away.
    void freeze() { is_frozen_ = true; }

    /// Ends the subscription, closes the own camera and gives all shares back; the configuration stays readable.
    void close();

    const std::optional<Configuration>& configuration() const { return configuration_; } ///< unset before the first one
    std::uint32_t epoch() const { return epoch_; }                                       ///< 0 before the first one

    /// The subscription to the feed of the configuration; its feed is null before the first grant and after `close`.
    feed::Subscription& subscription() { return subscription_; }

    /// The frame rate cap that the client asked for.
    feed::Pace& pace() { return pace_; }

    /// The client's own camera cannot render any more.
    bool has_camera_failed() const { return own_feed_.feed() != nullptr && own_feed_.feed()->has_failed(); }

private:
    std::optional<Refusal> admit(Configuration& wanted);     ///< on success its feed is where the frames come from
    std::optional<Refusal> subscribe(Configuration& wanted); ///< the same, without the checks of role and pixels
    tl::expected<feed::OwnFeed, Refusal> open_own_feed(const Configuration& wanted);
    std::optional<Refusal> change_own_feed(Configuration& wanted); ///< keeps the camera and changes its load
    void update_camera_share();                                    ///< to 1 with an own camera, to 0 without

    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    const Limits limits_;
    const feed::FrameCallback on_frame_;
    const bool may_steer_;
    bool is_frozen_ = false;
    std::optional<Configuration> configuration_;
    std::uint32_t epoch_ = 0;
    feed::Pace pace_;
    Share pixels_;  ///< of the views that the server makes for this client
    Share cameras_; ///< 1 while the client has a camera of its own
    feed::OwnFeed own_feed_; ///< none unless the channel gives every client a camera
    feed::Subscription subscription_; ///< last: ends before the feed that it belongs to
};

} // namespace fieldcast::session
