// SPDX-License-Identifier: Apache-2.0
#include "server/feed/feed.h"

#include "core/base/error.h"
#include "server/feed/frame_interval.h"

#include <algorithm>
#include <vector>

namespace fieldcast::feed {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kNewest = 4; // a new frame has the weight 1/4

std::shared_ptr<Steering> steering_of(const ChannelInfo& info, bool is_opened_by_each) {
    switch (info.control) {
    case CameraControl::kFixed:
    case CameraControl::kScripted:
        break;
    case CameraControl::kSteered:
        return std::make_shared<Steering>(info.steering_lease);
    case CameraControl::kOwn:
        return is_opened_by_each ? nullptr : std::make_shared<Steering>(kOwnCameraLease);
    }
    return nullptr;
}

} // namespace

Feed::Feed(ChannelInfo info, std::shared_ptr<FeedOpener> opener)
    : info_(std::move(info)), opener_(std::move(opener)), steering_(steering_of(info_, opener_ != nullptr)),
      frames_per_second_(info_.frames_per_second) {
    state_.lock()->held = std::make_unique<HeldViews>(info_.view_memory, info_.bytes_per_view_pixel);
}

std::optional<std::string> Feed::budget_problem(State& state, std::uint64_t except_id,
                                                const Selection& selection) const {
    Demand demand;
    for (const auto& [id, subscriber] : state.subscribers) {
        if (id != except_id) {
            add(demand, subscriber.selection);
        }
    }
    const std::uint64_t of_others = encoded_pixels(demand);
    add(demand, selection);
    const std::uint64_t pixels = encoded_pixels(demand);
    if (pixels == of_others || pixels <= info_.max_view_pixels) {
        auto problem = state.held->want(demand);
        return problem ? std::optional("channel '" + info_.name + "': " + *problem) : std::nullopt;
    }
    return "channel '" + info_.name + "' would encode " + std::to_string(pixels) +
           " pixels per frame for all clients, at most " + std::to_string(info_.max_view_pixels) +
           "; ask for fewer or smaller views, or for the lattice, codec and quality of another client";
}

std::uint64_t Feed::encoded_pixels(const Demand& demand) const {
    const GuardBand& band = info_.guard_band;
    const std::uint64_t plane = std::uint64_t{info_.source_width_px + band.left_px + band.right_px} *
                                (info_.source_height_px + band.top_px + band.bottom_px) * info_.source_count;
    return demand.view_pixels() + demand.repeated_planes() * plane;
}

tl::expected<Subscription, std::string> Feed::subscribe(const std::shared_ptr<Feed>& feed, const Selection& selection,
                                                        FrameCallback callback, const Pace& pace) {
    auto shared_callback = std::make_shared<const FrameCallback>(std::move(callback));
    std::uint64_t id = 0;
    {
        auto state = feed->state_.lock();
        if (auto problem = feed->budget_problem(*state, 0, selection)) {
            return tl::unexpected(std::move(*problem));
        }
        id = state->next_id++;
        state->subscribers.emplace(id, Subscriber{.selection = selection,
                                                  .pace = pace,
                                                  .has_room_since = Clock::now(),
                                                  .callback = std::move(shared_callback)});
        ++state->changes;
    }
    feed->demand_changed_.notify_all();
    return Subscription(feed, id);
}

std::optional<std::string> Feed::change(std::uint64_t id, const Selection& selection, const Pace& pace) {
    {
        auto state = state_.lock();
        if (auto problem = budget_problem(*state, id, selection)) {
            return problem;
        }
        Subscriber& subscriber = state->subscribers.at(id);
        subscriber.selection = selection;
        subscriber.pace = pace;
        state->shrunk = Clock::now();
        ++state->changes;
    }
    demand_changed_.notify_all(); // a frame may be due at once
    return std::nullopt;
}

void Feed::set_key_need(std::uint64_t id, KeyNeed need) {
    state_.lock()->subscribers.at(id).key_need = need;
}

void Feed::set_room(std::uint64_t id, const Room& room) {
    {
        auto state = state_.lock();
        Subscriber& subscriber = state->subscribers.at(id);
        const bool gets_room = subscriber.room.taken_until && !room.taken_until;
        subscriber.has_room_since = gets_room ? Clock::now() : subscriber.has_room_since;
        subscriber.room = room;
        ++state->changes;
    }
    demand_changed_.notify_all();
}

void Feed::remove(std::uint64_t id) {
    Subscriber removed; // destroyed after the lock is released
    auto state = state_.lock();
    const auto found = state->subscribers.find(id);
    removed = std::move(found->second);
    state->subscribers.erase(found);
    Demand left;
    for (const auto& [other, subscriber] : state->subscribers) {
        add(left, subscriber.selection);
    }
    FC_ASSERT(!state->held->want(left), "a smaller demand is always possible");
    state->shrunk = Clock::now();
    ++state->changes;
    demand_changed_.notify_all(); // unwanted views are to be freed after kKeepViews
}

std::optional<Demand> Feed::surplus(TimePoint now) {
    auto state = state_.lock();
    if (!state->held->has_surplus() || now < state->shrunk + kKeepViews) {
        return std::nullopt;
    }
    Demand wanted;
    wanted.views = state->held->wanted();
    return wanted;
}

void Feed::forgot_all_but(const Demand& kept) {
    state_.lock()->held->settle(kept.views);
}

Demand Feed::demand(TimePoint now) {
    Demand demand;
    demand.begun = now;
    auto state = state_.lock();
    for (auto& [id, subscriber] : state->subscribers) {
        const Window window = window_of(subscriber.room, subscriber.pace, lead(*state));
        demand.is_awaited = demand.is_awaited || (window.from - kAwaited <= now && now <= window.until);
        if (window.contains(now)) {
            subscriber.pace.take(now);
            add(demand, subscriber.selection);
            add(demand, subscriber.key_need);
        }
    }
    return demand;
}

// A frame begins one interval after the previous one, or as soon as that one is rendered, whichever is later.
Feed::TimePoint::duration Feed::lead(const State& state) const {
    const auto interval = std::chrono::duration_cast<TimePoint::duration>(frame_interval(frames_per_second()));
    return state.frame_time + std::max(state.frame_time, interval);
}

Feed::TimePoint Feed::wakes_at(const State& state, TimePoint now) const {
    TimePoint earliest = state.held->has_surplus() ? state.shrunk + kKeepViews : TimePoint::max();
    for (const auto& [id, subscriber] : state.subscribers) {
        const Window window = window_of(subscriber.room, subscriber.pace, lead(state));
        if (now <= window.until) {
            earliest = std::min(earliest, window.from - kAwaited);
        }
    }
    return earliest;
}

void Feed::wake() {
    { auto state = state_.lock(); } // else a waiter between its test and its sleep would miss the notification
    demand_changed_.notify_all();
}

bool Feed::wait_for_demand(const std::stop_token& stop) {
    const std::stop_callback stopping(stop, [this] { wake(); });
    auto state = state_.lock();
    while (!stop.stop_requested()) {
        const auto now = Clock::now();
        const TimePoint at = wakes_at(*state, now);
        if (at <= now) {
            return true;
        }
        const std::uint64_t seen = state->changes;
        const auto has_changed = [&](const State& s) { return stop.stop_requested() || s.changes != seen; };
        if (at == TimePoint::max()) {
            state.wait(demand_changed_, has_changed);
        } else {
            state.wait_until(demand_changed_, at, has_changed);
        }
    }
    return false;
}

bool Feed::wait_for_subscribers(const std::stop_token& stop) {
    const std::stop_callback stopping(stop, [this] { wake(); });
    auto state = state_.lock();
    state.wait(demand_changed_, [&](const State& s) { return stop.stop_requested() || !s.subscribers.empty(); });
    return !stop.stop_requested();
}

void Feed::publish(const FramePtr& frame, TimePoint now) {
    std::vector<std::shared_ptr<const FrameCallback>> callbacks;
    {
        auto state = state_.lock();
        state->published = now;
        if (frame->begun) {
            const auto taken = now - *frame->begun;
            const bool is_first = state->frame_time == TimePoint::duration(0);
            state->frame_time += is_first ? taken : (taken - state->frame_time) / kNewest;
        }
        state->latest = {.frame_id = frame->header.frame_id, .scene_time_ns = frame->header.scene_time_ns};
        if (state->observer) {
            callbacks.push_back(state->observer);
        }
        for (const auto& [id, subscriber] : state->subscribers) {
            callbacks.push_back(subscriber.callback);
        }
    }
    for (const auto& callback : callbacks) {
        (*callback)(frame);
    }
}

LatestFrame Feed::latest() {
    return state_.lock()->latest;
}

std::chrono::nanoseconds Feed::waiting_time(std::chrono::steady_clock::time_point now) {
    if (opener_ != nullptr) {
        return opener_->waiting_time(now);
    }
    std::chrono::nanoseconds longest(0);
    const auto interval = std::chrono::duration_cast<TimePoint::duration>(frame_interval(frames_per_second()));
    auto state = state_.lock();
    for (const auto& [id, subscriber] : state->subscribers) {
        const auto since = std::max({state->published + interval, subscriber.has_room_since, subscriber.pace.due()});
        longest = subscriber.room.taken_until ? longest : std::max<std::chrono::nanoseconds>(longest, now - since);
    }
    return longest;
}

std::size_t Feed::subscriber_count() {
    return state_.lock()->subscribers.size();
}

Subscription& Subscription::operator=(Subscription&& other) noexcept {
    if (this != &other) {
        end();
        feed_ = std::move(other.feed_);
        id_ = other.id_;
    }
    return *this;
}

void Subscription::end() {
    if (feed_ != nullptr) {
        feed_->remove(id_);
        feed_.reset();
    }
}

} // namespace fieldcast::feed
