// SPDX-License-Identifier: Apache-2.0
#include "server/feed/feed.h"

#include "server/feed/frame_interval.h"

#include <algorithm>
#include <vector>

namespace fieldcast::feed {

namespace {

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
      frames_per_second_(info_.frames_per_second) {}

std::optional<std::string> Feed::budget_problem(const State& state, std::uint64_t except_id, const Wish& wish) const {
    Demand demand;
    for (const auto& [id, subscriber] : state.subscribers) {
        if (id != except_id) {
            add(demand, subscriber.wish);
        }
    }
    const std::uint64_t of_others = encoded_pixels(demand);
    add(demand, wish);
    const std::uint64_t pixels = encoded_pixels(demand);
    if (pixels == of_others || pixels <= info_.max_view_pixels) {
        return std::nullopt;
    }
    return "channel '" + info_.name + "' would encode " + std::to_string(pixels) +
           " pixels per frame for all clients, at most " + std::to_string(info_.max_view_pixels) +
           "; ask for fewer or smaller views, or for what others get: lattice, codec and quality";
}

std::uint64_t Feed::encoded_pixels(const Demand& demand) const {
    const GuardBand& band = info_.guard_band;
    const std::uint64_t plane = std::uint64_t{info_.source_width_px + band.left_px + band.right_px} *
                                (info_.source_height_px + band.top_px + band.bottom_px) * info_.source_count;
    return demand.view_pixels() + demand.repeated_planes() * plane;
}

tl::expected<Subscription, std::string> Feed::subscribe(const std::shared_ptr<Feed>& feed, const Wish& wish,
                                                        FrameCallback callback) {
    auto shared_callback = std::make_shared<const FrameCallback>(std::move(callback));
    std::uint64_t id = 0;
    {
        auto state = feed->state_.lock();
        if (auto problem = feed->budget_problem(*state, 0, wish)) {
            return tl::unexpected(std::move(*problem));
        }
        id = state->next_id++;
        if (state->subscribers.empty()) {
            state->waiting_since = std::chrono::steady_clock::now();
            state->is_first_due = true;
        }
        state->subscribers.emplace(id, Subscriber{.wish = wish, .callback = std::move(shared_callback)});
    }
    feed->demand_changed_.notify_all();
    return Subscription(feed, id);
}

std::optional<std::string> Feed::change(std::uint64_t id, const Wish& wish) {
    auto state = state_.lock();
    if (auto problem = budget_problem(*state, id, wish)) {
        return problem;
    }
    state->subscribers.at(id).wish = wish;
    return std::nullopt;
}

void Feed::set_key_need(std::uint64_t id, KeyNeed need) {
    state_.lock()->subscribers.at(id).key_need = need;
}

void Feed::remove(std::uint64_t id) {
    Subscriber removed; // destroyed after the lock is released
    auto state = state_.lock();
    const auto found = state->subscribers.find(id);
    removed = std::move(found->second);
    state->subscribers.erase(found);
}

Demand Feed::demand() {
    Demand demand;
    auto state = state_.lock();
    for (const auto& [id, subscriber] : state->subscribers) {
        add(demand, subscriber.wish);
        add(demand, subscriber.key_need);
    }
    return demand;
}

bool Feed::wait_for_demand(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] {
        { auto state = state_.lock(); } // not between a waiter's test and its sleep
        demand_changed_.notify_all();
    });
    auto state = state_.lock();
    state.wait(demand_changed_, [&](const State& s) { return stop.stop_requested() || !s.subscribers.empty(); });
    return !stop.stop_requested();
}

void Feed::publish(const FramePtr& frame) {
    std::vector<std::shared_ptr<const FrameCallback>> callbacks;
    {
        auto state = state_.lock();
        state->waiting_since = std::chrono::steady_clock::now();
        state->is_first_due = false;
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
    const auto interval = frame_interval(frames_per_second());
    auto state = state_.lock();
    if (state->subscribers.empty()) {
        return std::chrono::nanoseconds(0);
    }
    const auto due = state->waiting_since + (state->is_first_due ? std::chrono::nanoseconds(0) : interval);
    return std::max<std::chrono::nanoseconds>(now - due, std::chrono::nanoseconds(0));
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
