// SPDX-License-Identifier: Apache-2.0
#include "client/play/local_renderers.h"

#include "client/play/no_device_for_views.h"
#include "client/play/scene_source.h"
#include "core/base/error.h"
#include "core/base/log.h"

#include <string>

namespace fieldcast::client::play {

std::unique_ptr<LocalRenderers> LocalRenderers::make(const PlayOptions& options, const std::stop_token& stop) {
    const bool plays_scenes = needs_scene(options);
    const bool plays_warps = asks_for(options, DeliveryMode::kWarp);
    if (!plays_scenes && !plays_warps) {
        return nullptr;
    }
    gpu::DeviceOptions device_options;
    device_options.name_contains = options.device;
    std::unique_ptr<LocalRenderers> renderers;
    try {
        renderers.reset(new LocalRenderers(device_options));
    } catch (const gpu::NoDeviceError& error) {
        const DeliveryMode mode = plays_scenes ? DeliveryMode::kScene : DeliveryMode::kWarp;
        throw NoDeviceForViews("mode " + std::string(word_of(mode)) +
                               " makes its views on a Vulkan device of this machine: " + error.what() +
                               ". With --mode views, the server makes them.");
    }
    const gpu::DeviceInfo& device = renderers->device_.info();
    log::info("device chosen", {{"name", device.name}, {"driver", device.driver}});
    if (plays_warps) {
        renderers->warp_.emplace(renderers->device_);
    }
    if (plays_scenes) {
        scene::Scene scene = obtain_scene(options.server, options.request.channel, options.cache_folder, stop);
        renderers->hash_ = scene.hash;
        renderers->scene_.emplace(renderers->device_, std::move(scene), options.traversal, options.visibility);
    }
    return renderers;
}

Decoded<Views> LocalRenderers::play(DeliveryMode mode, const SourceFrame& frame, const wire::ViewSet& set) {
    switch (mode) {
    case DeliveryMode::kViews:
        break;
    case DeliveryMode::kScene:
        FC_ASSERT(scene_.has_value(), "agreements have requested modes only");
        return scene_->play(frame, set);
    case DeliveryMode::kWarp:
        FC_ASSERT(warp_.has_value(), "agreements have requested modes only");
        return warp_->play(frame, set);
    }
    FC_ASSERT(false, "the server makes the views of this mode");
    return decode_error("");
}

} // namespace fieldcast::client::play
