// SPDX-License-Identifier: Apache-2.0
#include "client/play/render_side.h"

#include "client/play/playback.h"
#include "client/play/scene_source.h"

#include "core/base/log.h"

namespace fieldcast::client::play {

std::unique_ptr<RenderSide> RenderSide::make(const PlayOptions& options, const std::stop_token& stop) {
    const bool plays_scenes = needs_scene(options);
    if (!plays_scenes && !asks_for(options, DeliveryMode::kWarp)) {
        return nullptr;
    }
    gpu::DeviceOptions device_options;
    device_options.name_contains = options.device;
    std::unique_ptr<RenderSide> side;
    try {
        side.reset(new RenderSide(device_options));
    } catch (const gpu::NoDeviceError& error) {
        throw NoDeviceForViews(std::string(plays_scenes ? "mode scene" : "mode warp") +
                               " makes its views on a Vulkan device of this machine: " + error.what() +
                               ". With --mode views the server makes them.");
    }
    log::info("device chosen", {{"name", side->device_.info().name}, {"driver", side->device_.info().driver}});
    if (asks_for(options, DeliveryMode::kWarp)) {
        side->warp_.emplace(side->device_);
    }
    if (plays_scenes) {
        scene::Scene scene = obtain_scene(options.server, options.request.channel, options.cache_folder, stop);
        side->hash_ = scene.hash;
        side->scene_.emplace(side->device_, std::move(scene), options.traversal, options.visibility);
    }
    return side;
}

Decoded<Views> RenderSide::play(DeliveryMode mode, const SourceFrame& frame, const wire::ViewSet& set) {
    switch (mode) {
    case DeliveryMode::kViews:
        break;
    case DeliveryMode::kScene:
        FC_ASSERT(scene_.has_value(), "only asked modes are agreed on");
        return scene_->play(frame, set);
    case DeliveryMode::kWarp:
        FC_ASSERT(warp_.has_value(), "only asked modes are agreed on");
        return warp_->play(frame, set);
    }
    FC_ASSERT(false, "finished views need no renderer");
    return decode_error("");
}

} // namespace fieldcast::client::play
