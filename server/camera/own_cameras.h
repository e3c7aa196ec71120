// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/base/log_quota.h"
#include "server/camera/admission.h"
#include "server/feed/feed.h"
#include "server/metrics/registry.h"

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace fieldcast::camera {

/// Outputs of one camera: its frames, and the device time that each one used.
struct CameraPlace {
    std::shared_ptr<feed::Feed> feed;
    std::function<void(std::chrono::duration<double>)> used; ///< gets the device time of each frame; from any thread
};

/// Starts a camera that publishes frames to `place.feed` until the returned object is destroyed. Both may take seconds;
/// throws if the camera cannot be made.
using MakeCamera = std::function<std::shared_ptr<void>(CameraPlace place)>;

/// All cameras that belong to one client each. One thread makes and ends them, one after the other, and a camera counts
/// until it is destroyed: clients that reconnect often cannot exceed the limits on threads and memory. Thread-safe.
class OwnCameras {
public:
    /// `registry` must outlive it.
    OwnCameras(const Limits& limits, metrics::Registry& registry);

    /// All feeds must be closed before.
    ~OwnCameras();
    OwnCameras(const OwnCameras&) = delete;
    OwnCameras& operator=(const OwnCameras&) = delete;

    /// A channel that gives every client a camera.
    struct ChannelSetup {
        feed::ChannelInfo info; ///< also the info of the feeds that are opened
        FrameCost cost;         ///< estimate for one of its frames
        MakeCamera make;
    };
    /// Opens feeds of that channel; must not be used after the OwnCameras is destroyed.
    std::shared_ptr<feed::FeedOpener> opener(ChannelSetup setup);

private:
    class Opener;
    using Id = Admission::Id;
    enum class Stage : std::uint8_t { kWaiting, kBeingMade, kMade, kFailed };
    struct Camera {
        std::shared_ptr<const ChannelSetup> channel;
        std::shared_ptr<feed::Feed> feed;
        std::shared_ptr<void> running; ///< null before it is made
        Stage stage = Stage::kWaiting;
        bool is_closed = false;
    };
    struct State {
        explicit State(const Limits& limits) : admission(limits) {}
        Admission admission;
        std::map<Id, Camera> cameras;
        std::vector<std::string> channels;
        Id last_id = 0;
    };

    tl::expected<Id, Rejection> add(const std::shared_ptr<const ChannelSetup>& channel,
                                    const std::shared_ptr<feed::Feed>& feed, const feed::CameraLoad& load,
                                    std::optional<Id> replaced);
    std::optional<std::string> change(Id id, const feed::CameraLoad& load);
    void close(Id id);
    void observe(Id id, std::chrono::duration<double> used);
    std::chrono::nanoseconds waiting_time(const ChannelSetup* channel, std::chrono::steady_clock::time_point now);

    void work(const std::stop_token& stop);
    std::optional<Id> next_job(const std::stop_token& stop); ///< waits for a camera to make or end; empty: stopped
    void do_job(Id id);
    std::shared_ptr<void> make(Id id, const ChannelSetup& channel, const std::shared_ptr<feed::Feed>& feed);
    void collect(metrics::Page& page);
    metrics::Counter& refused(const std::string& channel, Shortage shortage); ///< counter of refusals

    metrics::Registry& registry_;
    log::Quota lines_{"everybody", log::Quota::kOfEverybody};
    std::condition_variable changed_;
    Guarded<State> state_;
    metrics::Collector collector_;
    std::jthread thread_;
};

} // namespace fieldcast::camera
