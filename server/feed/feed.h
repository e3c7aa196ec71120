// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/feed/channel_info.h"
#include "server/feed/encoded_frame.h"
#include "server/feed/feed_opener.h"
#include "server/feed/room.h"
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
//     session:      subscription = Feed::subscribe(feed, selection, on_frame);   … subscription.change(selection) …
//
// A selection counts for a frame only if its subscriber could take that frame: its pace says that it is due, and it has room.
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
    using TimePoint = std::chrono::steady_clock::time_point;

    /// Before somebody wants a frame; enough for the source's averages to settle.
    static constexpr std::chrono::seconds kAwaited{1};

    /// With an `opener` the feed itself never has frames: whoever wants some opens a feed of its own.
    explicit Feed(ChannelInfo info, std::shared_ptr<FeedOpener> opener = nullptr);

    const ChannelInfo& info() const { return info_; }

    /// Null: the feed is for everybody, or for the one who opened it.
    const std::shared_ptr<FeedOpener>& opener() const { return opener_; }

    /// Null: nobody steers the camera of this channel.
    const std::shared_ptr<Steering>& steering() const { return steering_; }

    /// Refused, with a reason that names the limit, if what is encoded for all subscribers would exceed the pixel
    /// budget, or their views the memory of the device. Whoever wants only what others get is never refused.
    static tl::expected<Subscription, std::string> subscribe(const std::shared_ptr<Feed>& feed, const Selection& selection,
                                                             FrameCallback callback, const Pace& pace = {});

    /// What a frame that begins at `now` has to contain. Each call is one frame.
    Demand demand(TimePoint now = std::chrono::steady_clock::now());

    /// Sleeps until somebody wants a frame, or will want one within kAwaited. False: `stop` was requested.
    bool wait_for_demand(const std::stop_token& stop);

    /// Sleeps until there are subscribers, whether they have room or not. False: `stop` was requested.
    bool wait_for_subscribers(const std::stop_token& stop);

    /// What is wanted by whoever is there, if nobody has wanted more for kKeepViews and the channel may hold more: then it
    /// forgets the rest, and says so. `wait_for_demand` returns when that is due.
    std::optional<Demand> surplus(TimePoint now);
    void forgot_all_but(const Demand& kept);
    static constexpr std::chrono::seconds kKeepViews{5};

    /// Gives `frame` to every subscriber, and to the observer before.
    void publish(const FramePtr& frame, TimePoint now = std::chrono::steady_clock::now());

    /// `observer` sees every frame from now on without wanting anything.
    void observe(FrameCallback observer) {
        state_.lock()->observer = std::make_shared<const FrameCallback>(std::move(observer));
    }

    LatestFrame latest();

    /// How many frames are wanted at most; those of the channel unless somebody says otherwise.
    float frames_per_second() const { return frames_per_second_; }
    void set_frames_per_second(float rate) { frames_per_second_ = rate; }

    /// How long somebody who has room, and for whom a frame is due, has been waiting for it; 0: nobody is.
    std::chrono::nanoseconds waiting_time(TimePoint now);
    std::size_t subscriber_count();

    /// The channel cannot render any more; the reason was logged.
    void set_failed() { has_failed_ = true; }
    bool has_failed() const { return has_failed_; }

private:
    friend class Subscription;
    struct Subscriber {
        Selection selection;
        KeyNeed key_need = KeyNeed::kAlone;
        Pace pace{};
        Room room{};
        TimePoint has_room_since;
        std::shared_ptr<const FrameCallback> callback;
    };
    struct State {
        std::map<std::uint64_t, Subscriber> subscribers;
        std::shared_ptr<const FrameCallback> observer; ///< may be null
        std::uint64_t next_id = 1;
        LatestFrame latest;
        TimePoint published{};            ///< the last frame
        TimePoint::duration frame_time{}; ///< from the demand for a frame to its publication, lately
        std::uint64_t changes = 0;        ///< of what `wait_for_demand` looks at
        std::unique_ptr<HeldViews> held;  ///< in the device's memory
        TimePoint shrunk{};               ///< when a selection went or changed
    };

    std::uint64_t encoded_pixels(const Demand& demand) const;
    /// Whether `selection` fits besides those of all others but `except_id`; if so, its memory is taken.
    std::optional<std::string> budget_problem(State& state, std::uint64_t except_id, const Selection& selection) const;
    std::optional<std::string> change(std::uint64_t id, const Selection& selection, const Pace& pace);
    void set_key_need(std::uint64_t id, KeyNeed need);
    void set_room(std::uint64_t id, const Room& room);
    void remove(std::uint64_t id);
    TimePoint::duration lead(const State& state) const; ///< from the demand for a frame to having it, at most
    TimePoint wakes_at(const State& state, TimePoint now) const; ///< somebody waits for a frame; max: nobody
    void wake(); ///< whoever waits

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

    /// Another selection from the next frame on. On failure the old one stays; the reason names the limit.
    std::optional<std::string> change(const Selection& selection, const Pace& pace = {}) {
        return feed_->change(id_, selection, pace);
    }
    void end();

    /// From the next frame on; kAlone at first.
    void set_key_need(KeyNeed need) { feed_->set_key_need(id_, need); }

    /// At once; it has some at first.
    void set_room(const Room& room) { feed_->set_room(id_, room); }

private:
    friend class Feed;
    Subscription(std::shared_ptr<Feed> feed, std::uint64_t id) : feed_(std::move(feed)), id_(id) {}

    std::shared_ptr<Feed> feed_;
    std::uint64_t id_ = 0;
};

} // namespace fieldcast::feed
