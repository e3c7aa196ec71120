// SPDX-License-Identifier: Apache-2.0
#include "server/camera/own_cameras.h"

#include <algorithm>
#include <exception>

namespace fieldcast::camera {

namespace {

using Clock = std::chrono::steady_clock;

const char* label_of(Shortage shortage) {
    switch (shortage) {
    case Shortage::kCameras:
        break;
    case Shortage::kTime:
        return "device_time";
    }
    return "cameras";
}

std::string refusal_text(const std::string& channel, const Rejection& rejection) {
    return "channel '" + channel + "' gives every client a camera: " + rejection.message;
}

std::chrono::duration<double> since(Clock::time_point begin) {
    return Clock::now() - begin;
}

} // namespace

/// Opens the feeds of one channel.
class OwnCameras::Opener final : public feed::FeedOpener {
public:
    Opener(OwnCameras& cameras, ChannelSetup setup)
        : cameras_(cameras), setup_(std::make_shared<const ChannelSetup>(std::move(setup))) {}

    tl::expected<feed::OwnFeed, std::string> open(const feed::CameraLoad& load,
                                                  const feed::OwnFeed* replaced) override {
        auto feed = std::make_shared<feed::Feed>(setup_->info);
        feed->set_frames_per_second(load.frames_per_second);
        const auto id =
            cameras_.add(setup_, feed, load, replaced != nullptr ? std::optional(replaced->id()) : std::nullopt);
        if (!id) {
            return tl::unexpected(refusal_text(setup_->info.name, id.error()));
        }
        return feed::OwnFeed(shared_from_this(), *id, std::move(feed));
    }

    std::chrono::nanoseconds waiting_time(Clock::time_point now) override {
        return cameras_.waiting_time(setup_.get(), now);
    }

private:
    std::optional<std::string> change(std::uint64_t id, const feed::CameraLoad& load) override {
        return cameras_.change(id, load);
    }
    void close(std::uint64_t id) override { cameras_.close(id); }

    OwnCameras& cameras_;
    const std::shared_ptr<const ChannelSetup> setup_;
};

OwnCameras::OwnCameras(const Limits& limits, metrics::Registry& registry)
    : registry_(registry), state_(State(limits)),
      collector_(registry.on_collect([this](metrics::Page& page) { collect(page); })),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

OwnCameras::~OwnCameras() {
    collector_.end();
    thread_ = {}; // stops and joins
    std::map<Id, Camera> left; // destroyed without the lock, which cameras take to report device time
    std::swap(left, state_.lock()->cameras);
}

std::shared_ptr<feed::FeedOpener> OwnCameras::opener(ChannelSetup setup) {
    for (const Shortage shortage : {Shortage::kCameras, Shortage::kTime}) {
        refused(setup.info.name, shortage); // shown from the start, as 0
    }
    {
        auto state = state_.lock();
        state->admission.estimate(setup.info.name, setup.cost);
        state->channels.push_back(setup.info.name);
    }
    return std::make_shared<Opener>(*this, std::move(setup));
}

tl::expected<OwnCameras::Id, Rejection> OwnCameras::add(const std::shared_ptr<const ChannelSetup>& channel,
                                                        const std::shared_ptr<feed::Feed>& feed,
                                                        const feed::CameraLoad& load, std::optional<Id> replaced) {
    std::optional<Rejection> problem;
    Id id = 0;
    {
        auto state = state_.lock();
        id = ++state->last_id;
        state->admission.look_at_clock(Clock::now());
        problem = state->admission.admit(id, channel->info.name, load, replaced);
        if (!problem) {
            state->cameras.emplace(id, Camera{.channel = channel, .feed = feed, .running = nullptr});
        }
    }
    if (problem) {
        refused(channel->info.name, problem->shortage).add();
        return tl::unexpected(std::move(*problem));
    }
    changed_.notify_all();
    return id;
}

std::optional<std::string> OwnCameras::change(Id id, const feed::CameraLoad& load) {
    std::optional<Rejection> problem;
    std::string channel;
    {
        auto state = state_.lock();
        const Camera& camera = state->cameras.at(id);
        channel = camera.channel->info.name;
        state->admission.look_at_clock(Clock::now());
        problem = state->admission.change(id, load);
        if (!problem) {
            camera.feed->set_frames_per_second(load.frames_per_second);
        }
    }
    if (!problem) {
        return std::nullopt;
    }
    refused(channel, problem->shortage).add();
    return refusal_text(channel, *problem);
}

void OwnCameras::close(Id id) {
    {
        auto state = state_.lock();
        Camera& camera = state->cameras.at(id);
        camera.is_closed = true;
        state->admission.stop(id);
        if (camera.stage == Stage::kWaiting) { // not made yet: nothing to end
            state->admission.leave(id);
            state->cameras.erase(id);
        }
    }
    changed_.notify_all(); // the camera that replaces it may be made now
}

void OwnCameras::observe(Id id, std::chrono::duration<double> used) {
    auto state = state_.lock();
    state->admission.look_at_clock(Clock::now());
    state->admission.observe(id, used);
}

std::chrono::nanoseconds OwnCameras::waiting_time(const ChannelSetup* channel, Clock::time_point now) {
    std::vector<std::shared_ptr<feed::Feed>> feeds;
    {
        auto state = state_.lock();
        for (const auto& [id, camera] : state->cameras) {
            if (camera.channel.get() == channel && !camera.is_closed && camera.stage != Stage::kFailed) {
                feeds.push_back(camera.feed);
            }
        }
    }
    std::chrono::nanoseconds longest(0);
    for (const auto& feed : feeds) {
        longest = std::max(longest, feed->waiting_time(now));
    }
    return longest;
}

void OwnCameras::work(const std::stop_token& stop) {
    while (const auto id = next_job(stop)) {
        do_job(*id);
    }
}

std::optional<OwnCameras::Id> OwnCameras::next_job(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] {
        { auto state = state_.lock(); } // else a waiter between its test and its sleep would miss the notification
        changed_.notify_all();
    });
    const auto is_ended = [](const auto& entry) { return entry.second.is_closed; };
    std::optional<Id> job;
    state_.lock().wait(changed_, [&](const State& state) {
        const auto is_new = [&](const auto& entry) {
            return entry.second.stage == Stage::kWaiting && state.admission.has_place(entry.first);
        };
        auto found = std::ranges::find_if(state.cameras, is_ended); // first: ending a camera makes room
        found = found == state.cameras.end() ? std::ranges::find_if(state.cameras, is_new) : found;
        job = found == state.cameras.end() ? std::nullopt : std::optional(found->first);
        return stop.stop_requested() || job;
    });
    return stop.stop_requested() ? std::nullopt : job;
}

void OwnCameras::do_job(Id id) {
    Camera job; // made or ended without the lock
    {
        auto state = state_.lock();
        const auto found = state->cameras.find(id);
        if (found == state->cameras.end()) {
            return; // closed while it waited
        }
        if (found->second.is_closed) {
            job.running = std::move(found->second.running);
            job.is_closed = true;
        } else {
            found->second.stage = Stage::kBeingMade;
            job = found->second;
        }
    }
    std::shared_ptr<void> made = job.is_closed ? nullptr : make(id, *job.channel, job.feed);
    job.running.reset();
    auto state = state_.lock();
    if (job.is_closed) {
        state->admission.leave(id);
        state->cameras.erase(id);
        return;
    }
    Camera& camera = state->cameras.at(id);
    camera.stage = made != nullptr ? Stage::kMade : Stage::kFailed;
    camera.running = std::move(made);
}

std::shared_ptr<void> OwnCameras::make(Id id, const ChannelSetup& channel, const std::shared_ptr<feed::Feed>& feed) {
    const auto begin = Clock::now();
    try {
        auto made = channel.make(
            {.feed = feed, .used = [this, id](std::chrono::duration<double> used) { observe(id, used); }});
        lines_.write(log::Level::kInfo, "own camera ready",
                     {{"channel", channel.info.name}, {"camera", id}, {"seconds", since(begin).count()}});
        return made;
    } catch (const std::exception& problem) {
        lines_.write(log::Level::kError, "own camera failed",
                     {{"channel", channel.info.name}, {"camera", id}, {"problem", problem.what()}});
        feed->set_failed();
        return nullptr;
    }
}

void OwnCameras::collect(metrics::Page& page) {
    auto state = state_.lock();
    state->admission.look_at_clock(Clock::now());
    for (const std::string& channel : state->channels) {
        const metrics::Labels labels{{"channel", channel}};
        page.add_gauge({"fieldcast_own_cameras", "Cameras that belong to one client each, including those that are "
                                                 "being made or ended."},
                       labels, static_cast<double>(state->admission.cameras_of(channel)));
        page.add_gauge({"fieldcast_own_camera_promised_ratio", "Device seconds per second that are promised to own "
                                                               "cameras that render."},
                       labels, state->admission.promised_ms_per_second(channel) * 1e-3);
    }
}

metrics::Counter& OwnCameras::refused(const std::string& channel, Shortage shortage) {
    return registry_.counter({"fieldcast_own_cameras_refused_total",
                              "Own cameras that clients were refused, by exhausted resource."},
                             {{"channel", channel}, {"reason", label_of(shortage)}});
}

} // namespace fieldcast::camera
