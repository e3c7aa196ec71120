// SPDX-License-Identifier: Apache-2.0
#include "client/play/scene_player.h"

#include "client/play/view_set_request.h"

#include <algorithm>

namespace fieldcast::client::play {
namespace {

bool has_surfaces(const SourceFrame& frame) {
    return std::all_of(render::kSourceSemantics.begin(), render::kSourceSemantics.end(),
                       [&](PlaneSemantic semantic) { return frame.find(semantic) != nullptr; });
}

} // namespace

ScenePlayer::ScenePlayer(const gpu::Device& device, scene::Scene scene, const std::string& traversal,
                         const std::string& visibility)
    : scene_(std::move(scene)), gpu_scene_(device, scene_, scene::choose_traversal(device, traversal),
                                           scene::choose_visibility(device, visibility)),
      planes_(device), surfaces_(device, gpu_scene_), views_(device, gpu_scene_) {}

Decoded<Views> ScenePlayer::play(const SourceFrame& frame, const wire::ViewSet& set) {
    gpu_scene_.pose(frame.header.scene_time_ns, frame.header.cut);
    if (const Decoded<bool> uploaded = planes_.upload(frame); !uploaded) {
        return tl::unexpected(uploaded.error());
    }
    const std::uint32_t expected_layers = gpu_scene_.has_blend() ? kMaxLayers : 0;
    if (frame.header.layer_count != expected_layers) {
        return decode_error("header.layer_count: " + std::to_string(frame.header.layer_count) + ", the scene needs " +
                            std::to_string(expected_layers));
    }
    if (expected_layers > 0 || !has_surfaces(frame)) { // surfaces of layers are never sent
        surfaces_.render(planes_);
    }
    return views_.render(planes_, view_set_request(set));
}

SourceFrame ScenePlayer::source() const {
    return planes_.download(render::kSourceSemantics);
}

} // namespace fieldcast::client::play
