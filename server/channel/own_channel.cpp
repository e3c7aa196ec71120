// SPDX-License-Identifier: Apache-2.0
#include "server/channel/own_channel.h"

#include "core/base/log.h"

#include <algorithm>

namespace fieldcast::channel {

namespace {

using Clock = std::chrono::steady_clock;

/// Four views, as at the start of the channel, so that all kernels are compiled already.
feed::Demand four_views(const feed::ChannelInfo& info) {
    ViewGrid grid = info.largest_grid;
    grid.rows = grid.cols = 2;
    feed::Demand demand;
    feed::add(demand, feed::ViewSelection{.format = {.geometry = grid.geometry,
                                                 .fovy_rad = info.fovy_rad,
                                                 .width_px = info.source_width_px,
                                                 .height_px = info.source_height_px,
                                                 .encoding = {}},
                                      .grid = grid});
    return demand;
}

/// Estimated from two frames; the actual cost of cameras replaces it later.
camera::FrameCost measure(FrameRenderer& renderer) {
    std::uint64_t frame_id = 0;
    const auto milliseconds = [&](const feed::Demand& demand) {
        const auto begin = Clock::now();
        renderer.render(++frame_id, {}, demand);
        return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    };
    const feed::Demand views = four_views(renderer.info());
    const double source_ms = milliseconds({});
    const double all_ms = milliseconds(views);
    const double megapixels = static_cast<double>(views.view_pixels()) * 1e-6;
    return {.source_ms = source_ms, .ms_per_view_megapixel = std::max(all_ms - source_ms, 0.0) / megapixels};
}

} // namespace

std::shared_ptr<feed::Feed> open_own_channel(const Channel::Shared& shared, const ChannelChoice& choice,
                                             camera::OwnCameras& cameras) {
    struct Server { // shared by all cameras of the channel; has the feed once it exists
        SettledChannel settled;
        ChannelClock::TimePoint begin;
        std::weak_ptr<feed::Feed> feed;
    };
    FrameRenderer renderer(shared.device, shared.settings, choice);
    const camera::FrameCost cost = measure(renderer);
    const auto server =
        std::make_shared<Server>(Server{.settled = renderer.settled(), .begin = Clock::now(), .feed = {}});
    log::info("own cameras", {{"channel", choice.name},
                              {"source_ms", cost.source_ms},
                              {"ms_per_view_megapixel", cost.ms_per_view_megapixel}});
    const auto make = [shared, server](camera::CameraPlace place) -> std::shared_ptr<void> {
        return std::make_shared<Channel>(shared, server->settled,
                                         Channel::Client{.feed = std::move(place.feed),
                                                         .used = std::move(place.used),
                                                         .begin = server->begin,
                                                         .server = server->feed});
    };
    server->settled.info.view_memory = shared.view_memory;
    const feed::ChannelInfo& info = server->settled.info;
    auto feed = std::make_shared<feed::Feed>(info, cameras.opener({.info = info, .cost = cost, .make = make}));
    server->feed = feed;
    return feed;
}

} // namespace fieldcast::channel
