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
// A selection counts for a frame only if its subscriber can take it: its pace must be due, and it must have room.
namespace fieldcast::feed {

/// Called by the publishing thread, which holds no lock. Must return at once and must not throw. One last call may
/// come while the subscription ends, or just after.
using FrameCallback = std::function<void(const FramePtr&)>;

/// Newest frame of a channel, for heartbeats.
struct LatestFrame {
    std::uint64_t frame_id = 0; ///< 0: none yet
    std::int64_t scene_time_ns = 0;
};

/// Lease of a client on its own camera: longer than any session lasts without a pose, so it needs no renewal.
inline constexpr std::chrono::hours kOwnCameraLease{24};

class Subscription;

/// All subscribers of one channel, and their selections. Thread-safe.
class Feed {
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    /// Rendering starts this long before a subscriber wants a frame, so that the source's averages can settle.
    static constexpr std::chrono::seconds kAwaited{1};

    /// With an `opener` this feed never has frames: every client that wants frames opens a feed of its own.
    explicit Feed(ChannelInfo info, std::shared_ptr<FeedOpener> opener = nullptr);

    const ChannelInfo& info() const { return info_; }

    /// Null: the feed itself has frames, for all clients or for the one that opened it.
    const std::shared_ptr<FeedOpener>& opener() const { return opener_; }

    /// Null: the camera of this channel cannot be steered.
    const std::shared_ptr<Steering>& steering() const { return steering_; }

    /// Adds a subscriber. Refused, with a reason that names the limit, if the pixels encoded for all subscribers would
    /// exceed the pixel budget, or their views the device memory. A selection that others have is never refused.
    static tl::expected<Subscription, std::string> subscribe(const std::shared_ptr<Feed>& feed,
                                                             const Selection& selection, FrameCallback callback,
                                                             const Pace& pace = {});

    /// The content that a frame begun at `now` must have. Each call stands for one frame.
    Demand demand(TimePoint now = std::chrono::steady_clock::now());

    /// Sleeps until a subscriber wants a frame, or will want one within kAwaited. False: `stop` was requested.
    bool wait_for_demand(const std::stop_token& stop);

    /// Sleeps until there are subscribers, whether they have room or not. False: `stop` was requested.
    bool wait_for_subscribers(const std::stop_token& stop);

    /// The views that are still wanted, if the channel may hold more, and no selection was removed or changed for
    /// kKeepViews. The channel then frees the others and calls `forgot_all_but`. `wait_for_demand` returns when that is
    /// due.
    std::optional<Demand> surplus(TimePoint now);
    void forgot_all_but(const Demand& kept); ///< the channel has freed the memory of all other views
    static constexpr std::chrono::seconds kKeepViews{5};

    /// Gives `frame` to the observer, then to every subscriber.
    void publish(const FramePtr& frame, TimePoint now = std::chrono::steady_clock::now());

    /// `observer` gets every frame from now on, but adds nothing to the demand.
    void observe(FrameCallback observer) {
        state_.lock()->observer = std::make_shared<const FrameCallback>(std::move(observer));
    }

    LatestFrame latest();

    /// Highest frame rate that is wanted; the channel's unless it was set.
    float frames_per_second() const { return frames_per_second_; }
    void set_frames_per_second(float rate) { frames_per_second_ = rate; }

    /// Longest time that a subscriber with room has been waiting for a frame that is due; 0: none is waiting.
    std::chrono::nanoseconds waiting_time(TimePoint now);
    std::size_t subscriber_count();

    /// The channel cannot render any more; the caller has logged the reason.
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
        TimePoint published{};            ///< time of the last frame
        TimePoint::duration frame_time{}; ///< recent average from the demand for a frame to its publication
        std::uint64_t changes = 0;        ///< number of changes of what `wait_for_demand` depends on
        std::unique_ptr<HeldViews> held;  ///< views in the device's memory
        TimePoint shrunk{};               ///< when a selection was last removed or changed
    };

    std::uint64_t encoded_pixels(const Demand& demand) const;
    /// Why `selection` does not fit beside those of all subscribers but `except_id`; empty: it fits, and its memory is
    /// taken.
    std::optional<std::string> budget_problem(State& state, std::uint64_t except_id, const Selection& selection) const;
    std::optional<std::string> change(std::uint64_t id, const Selection& selection, const Pace& pace);
    void set_key_need(std::uint64_t id, KeyNeed need);
    void set_room(std::uint64_t id, const Room& room);
    void remove(std::uint64_t id);
    TimePoint::duration lead(const State& state) const; ///< longest time from the demand for a frame to its publication
    TimePoint wakes_at(const State& state, TimePoint now) const; ///< when work is due; max: never
    void wake(); ///< all waiting threads

    const ChannelInfo info_;
    const std::shared_ptr<FeedOpener> opener_;
    const std::shared_ptr<Steering> steering_;
    std::atomic<float> frames_per_second_;
    std::atomic<bool> has_failed_ = false;
    std::condition_variable demand_changed_;
    Guarded<State> state_;
};

/// A client's subscription to a feed; ends when destroyed.
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

    /// Counts from the next frame on; kAlone at first.
    void set_key_need(KeyNeed need) { feed_->set_key_need(id_, need); }

    /// Counts at once; a new subscription has room.
    void set_room(const Room& room) { feed_->set_room(id_, room); }

private:
    friend class Feed;
    Subscription(std::shared_ptr<Feed> feed, std::uint64_t id) : feed_(std::move(feed)), id_(id) {}

    std::shared_ptr<Feed> feed_;
    std::uint64_t id_ = 0;
};

} // namespace fieldcast::feed
