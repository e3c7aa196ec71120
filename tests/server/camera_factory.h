// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/camera/own_cameras.h"
#include "tests/server/synthetic.h"

#include <algorithm>
#include <condition_variable>
#include <set>
#include <stdexcept>
#include <thread>

namespace fieldcast::test {

/// Makes synthetic cameras for OwnCameras, and knows which of them there are.
class CameraFactory {
public:
    /// No call waits longer; beyond, the test fails instead of hanging.
    static constexpr std::chrono::seconds kPatience{20};

    camera::MakeCamera maker() {
        return [this](camera::CameraPlace place) { return make(std::move(place)); };
    }

    /// Cameras are not finished before `open` is called.
    void shut() { state_.lock()->is_shut = true; }
    void open() {
        state_.lock()->is_shut = false;
        changed_.notify_all();
    }
    void fail_from_now_on() { state_.lock()->fails = true; }

    int begun() { return state_.lock()->begun; }
    int most_living() { return state_.lock()->most_living; } ///< at the same time
    int living() { return static_cast<int>(state_.lock()->living.size()); }
    bool wait_until_begun(int count) {
        return wait([=](const State& state) { return state.begun >= count; });
    }
    bool wait_until_living(int count) {
        return wait([=](const State& state) { return static_cast<int>(state.living.size()) == count; });
    }
    /// The cameras of these feeds live, and no others.
    bool wait_until_only(const std::vector<std::shared_ptr<feed::Feed>>& feeds) {
        return wait([&](const State& state) {
            return state.living.size() == feeds.size() &&
                   std::ranges::all_of(feeds, [&](const auto& feed) { return state.living.contains(feed.get()); });
        });
    }
    /// A camera of that feed lives.
    bool has(const std::shared_ptr<feed::Feed>& feed) { return state_.lock()->living.contains(feed.get()); }

    /// The frames of all cameras have cost that much.
    void tell_cost(std::chrono::duration<double> used) {
        const auto living = state_.lock()->living; // a copy: they ask for locks of their own
        for (const auto& [feed, tell] : living) {
            tell(used);
        }
    }

    std::set<std::thread::id> threads() { return state_.lock()->threads; } ///< on which cameras began and ended

private:
    struct State {
        bool is_shut = false;
        bool fails = false;
        int begun = 0;
        int most_living = 0;
        std::map<const feed::Feed*, std::function<void(std::chrono::duration<double>)>> living;
        std::set<std::thread::id> threads;
    };
    struct Camera {
        CameraFactory& factory;
        std::unique_ptr<SyntheticChannel> channel;
        ~Camera() {
            const feed::Feed* const feed = channel->feed().get();
            channel.reset(); // stops and joins
            {
                auto state = factory.state_.lock();
                state->living.erase(feed);
                state->threads.insert(std::this_thread::get_id());
            }
            factory.changed_.notify_all();
        }
    };

    std::shared_ptr<void> make(camera::CameraPlace place) {
        {
            auto state = state_.lock();
            ++state->begun;
            state->threads.insert(std::this_thread::get_id());
            changed_.notify_all();
            state.wait(changed_, [](const State& s) { return !s.is_shut; });
            if (state->fails) {
                throw std::runtime_error("the factory is out of memory");
            }
            state->living.emplace(place.feed.get(), std::move(place.used));
            state->most_living = std::max(state->most_living, static_cast<int>(state->living.size()));
        }
        changed_.notify_all();
        return std::shared_ptr<Camera>(new Camera{*this, std::make_unique<SyntheticChannel>(place.feed)});
    }

    template <class Predicate> bool wait(const Predicate& predicate) {
        return state_.lock().wait_until(changed_, std::chrono::steady_clock::now() + kPatience, predicate);
    }

    std::condition_variable changed_;
    Guarded<State> state_;
};

/// Facts about a channel that gives every client a camera.
inline feed::ChannelInfo own_info(const std::string& name = "own") {
    feed::ChannelInfo info = synthetic_info(name);
    info.control = feed::CameraControl::kOwn;
    return info;
}

/// Such a channel. A frame takes 1 ms and 4 ms per megapixel of views.
inline std::shared_ptr<feed::Feed> own_channel(camera::OwnCameras& cameras, CameraFactory& factory,
                                               const std::string& name = "own") {
    const feed::ChannelInfo info = own_info(name);
    return std::make_shared<feed::Feed>(
        info, cameras.opener({.info = info,
                              .cost = {.source_ms = 1.0, .ms_per_view_megapixel = 4.0},
                              .make = factory.maker()}));
}

} // namespace fieldcast::test
