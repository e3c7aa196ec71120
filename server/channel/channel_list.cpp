// SPDX-License-Identifier: Apache-2.0
#include "server/channel/channel_list.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/gpu/free_memory.h"
#include "core/scene/bundle.h"
#include "server/channel/own_channel.h"

#include <algorithm>

namespace fieldcast::channel {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

} // namespace

ChannelList::ChannelList(const Settings& settings, metrics::Registry& registry) {
    if (!settings.channels.empty()) {
        device_.emplace(gpu::DeviceOptions{.name_contains = settings.device, .validation = settings.has_validation});
        log::info("device", {{"name", device_->info().name}, {"driver", device_->info().driver}});
    }
    start_channels(settings, registry);
    limit_view_memory(settings);
    start_replays(settings, registry);
    start_recorders(settings, registry);
}

void ChannelList::add_feed(const std::shared_ptr<feed::Feed>& feed) {
    const std::string& name = feed->info().name;
    if (std::ranges::any_of(feeds_, [&](const auto& other) { return other->info().name == name; })) {
        throw UserError("two channels are named '" + name +
                        "'; tell them apart with --channel NAME=FILE or --replay NAME=FILE");
    }
    feeds_.push_back(feed);
}

void ChannelList::start_channels(const Settings& settings, metrics::Registry& registry) {
    for (const ChannelChoice& choice : settings.channels) {
        const auto begin = Clock::now();
        start_channel({.device = *device_,
                       .settings = settings,
                       .turns = turns_,
                       .registry = registry,
                       .view_memory = view_memory_},
                      choice);
        const feed::ChannelInfo& info = feeds_.back()->info();
        log::info("channel ready", {{"channel", info.name},
                                    {"scene", scene::to_hex(info.scene_hash)},
                                    {"camera", info.camera},
                                    {"width_px", info.source_width_px},
                                    {"height_px", info.source_height_px},
                                    {"spacing_m", info.largest_grid.geometry.spacing_m.x},
                                    {"seconds", seconds_since(begin)}});
    }
}

void ChannelList::start_channel(const Channel::Shared& shared, const ChannelChoice& choice) {
    if (choice.control != feed::CameraControl::kOwn) {
        channels_.push_back(std::make_unique<Channel>(shared, choice));
        return add_feed(channels_.back()->feed());
    }
    if (!own_cameras_) {
        own_cameras_.emplace(shared.settings.own_cameras, shared.registry);
    }
    add_feed(open_own_channel(shared, choice, *own_cameras_));
}

// Half of the memory that is free once all channels exist. Views in memory, frames in flight and others need the rest.
void ChannelList::limit_view_memory(const Settings& settings) {
    if (!device_) {
        return;
    }
    const std::uint64_t free = gpu::free_memory_bytes(*device_);
    view_memory_->set_limit(settings.max_view_memory.value_or(free / 2));
    log::info("memory for views", {{"limit_bytes", view_memory_->limit()}, {"free_bytes", free}});
}

void ChannelList::start_replays(const Settings& settings, metrics::Registry& registry) {
    for (const recording::ReplaySetup& setup : settings.replays) {
        const auto begin = Clock::now();
        replays_.push_back(std::make_unique<recording::Replay>(setup, registry));
        add_feed(replays_.back()->feed());
        const feed::ChannelInfo& info = feeds_.back()->info();
        std::string forms;
        for (const feed::Selection& selection : info.recorded) {
            forms += (forms.empty() ? "" : "; ") + feed::to_text(selection);
        }
        log::info("replay ready", {{"channel", info.name},
                                   {"file", setup.file.string()},
                                   {"scene", scene::to_hex(info.scene_hash)},
                                   {"frames", replays_.back()->frame_count()},
                                   {"recorded", forms},
                                   {"seconds", seconds_since(begin)}});
    }
}

void ChannelList::start_recorders(const Settings& settings, metrics::Registry& registry) {
    for (const RecordChoice& record : settings.records) {
        const auto found = std::ranges::find_if(
            feeds_, [&](const auto& feed) { return record.channel.empty() || feed->info().name == record.channel; });
        FC_ASSERT(found != feeds_.end(), "the configuration names a channel that is not there");
        recording::ChannelRecorderSetup setup{
            .file = record.file, .selections = {}, .max_frames = settings.record_frames};
        for (const recording::RecordedForm& form : settings.record_forms) {
            setup.selections.push_back(recording::selection_of(form, (*found)->info()));
        }
        recorders_.push_back(std::make_unique<recording::ChannelRecorder>(*found, std::move(setup), registry));
    }
}

} // namespace fieldcast::channel
