// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/feed/channel_info.h"
#include "server/feed/encoded_frame.h"
#include "server/feed/feed_opener.h"
#include "server/feed/steering.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <tl/expected.hpp>

// The border between a channel, which makes frames, and the sessions, which send them.
//
//     render loop:  feed->wait_for_demand(stop);  demand = feed->demand();  … render, encode …  feed->publish(frame);
//     session:      subscription = Feed::subscribe(feed, wish, on_frame);   … subscription.change(wish) …
namespace fieldcast::feed {

/// Called by the thread that publishes, without any lock held. Must return at once and must not throw. One last call
/// may still come while or just after the subscription ends.
using FrameCallback = std::function<void(const FramePtr&)>;

/// Newest frame of a channel, for heartbeats.
struct LatestFrame {
    std::uint64_t frame_id = 0; ///< 0: none yet
    std::int64_t scene_time_ns = 0;
};

/// A camera of one's own needs no renewal: longer than any session lasts without a pose.
inline constexpr std::chrono::hours kOwnCameraLease{24};

class Subscription;

/// All subscribers of one channel, and what they want. Thread-safe.
class Feed {
public:
    /// With an `opener` the feed itself never has frames: whoever wants some opens a feed of its own.
    explicit Feed(ChannelInfo info, std::shared_ptr<FeedOpener> opener = nullptr);

    const ChannelInfo& info() const { return info_; }

    /// Null: the feed is for everybody, or for the one who opened it.
    const std::shared_ptr<FeedOpener>& opener() const { return opener_; }

    /// Null: nobody steers the camera of this channel.
    const std::shared_ptr<Steering>& steering() const { return steering_; }

    /// Refused, with a reason that names the limit, if what is encoded for all subscribers would exceed the pixel
    /// budget. Whoever wants only what others get is never refused.
    static tl::expected<Subscription, std::string> subscribe(const std::shared_ptr<Feed>& feed, const Wish& wish,
                                                             FrameCallback callback);

    Demand demand();

    /// Sleeps until somebody wants something. False: `stop` was requested.
    bool wait_for_demand(const std::stop_token& stop);

    /// Gives `frame` to every subscriber, and to the observer before.
    void publish(const FramePtr& frame);

    /// `observer` sees every frame from now on without wanting anything.
    void observe(FrameCallback observer) {
        state_.lock()->observer = std::make_shared<const FrameCallback>(std::move(observer));
    }

    LatestFrame latest();

    /// How many frames are wanted at most; those of the channel unless somebody says otherwise.
    float frames_per_second() const { return frames_per_second_; }
    void set_frames_per_second(float rate) { frames_per_second_ = rate; }

    /// How long somebody has been waiting for a frame that is due; 0: nobody has.
    std::chrono::nanoseconds waiting_time(std::chrono::steady_clock::time_point now);
    std::size_t subscriber_count();

    /// The channel cannot render any more; the reason was logged.
    void set_failed() { has_failed_ = true; }
    bool has_failed() const { return has_failed_; }

private:
    friend class Subscription;
    struct Subscriber {
        Wish wish;
        KeyNeed key_need = KeyNeed::kAlone;
        std::shared_ptr<const FrameCallback> callback;
    };
    struct State {
        std::map<std::uint64_t, Subscriber> subscribers;
        std::shared_ptr<const FrameCallback> observer; ///< may be null
        std::uint64_t next_id = 1;
        LatestFrame latest;
        std::chrono::steady_clock::time_point waiting_since; ///< the last frame, or the first subscriber after a pause
        bool is_first_due = true; ///< a frame is due at once; false: an interval after `waiting_since`
    };

    std::uint64_t encoded_pixels(const Demand& demand) const;
    std::optional<std::string> budget_problem(const State& state, std::uint64_t except_id, const Wish& wish) const;
    std::optional<std::string> change(std::uint64_t id, const Wish& wish);
    void set_key_need(std::uint64_t id, KeyNeed need);
    void remove(std::uint64_t id);

    const ChannelInfo info_;
    const std::shared_ptr<FeedOpener> opener_;
    const std::shared_ptr<Steering> steering_;
    std::atomic<float> frames_per_second_;
    std::atomic<bool> has_failed_ = false;
    std::condition_variable demand_changed_;
    Guarded<State> state_;
};

/// A place in a feed; ends when destroyed.
class Subscription {
public:
    Subscription() = default;
    Subscription(Subscription&& other) noexcept : feed_(std::move(other.feed_)), id_(other.id_) {}
    Subscription& operator=(Subscription&& other) noexcept;
    ~Subscription() { end(); }

    /// Null after `end` or for a default-constructed one.
    const std::shared_ptr<Feed>& feed() const { return feed_; }

    /// Another wish from the next frame on. On failure the old one stays; the reason names the limit.
    std::optional<std::string> change(const Wish& wish) { return feed_->change(id_, wish); }
    void end();

    /// From the next frame on; kAlone at first.
    void set_key_need(KeyNeed need) { feed_->set_key_need(id_, need); }

private:
    friend class Feed;
    Subscription(std::shared_ptr<Feed> feed, std::uint64_t id) : feed_(std::move(feed)), id_(id) {}

    std::shared_ptr<Feed> feed_;
    std::uint64_t id_ = 0;
};

} // namespace fieldcast::feed
