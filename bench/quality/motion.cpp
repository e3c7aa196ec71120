// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/motion.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

/// Sets all of `line` within `radius` of a set element; elements are `stride` apart.
void widen(std::vector<bool>& mask, std::size_t first, std::size_t count, std::size_t stride, std::size_t radius) {
    std::vector<std::size_t> set;
    for (std::size_t i = 0; i < count; ++i) {
        if (mask[first + i * stride]) {
            set.push_back(i);
        }
    }
    for (const std::size_t centre : set) {
        for (std::size_t i = centre - std::min(centre, radius); i <= std::min(count - 1, centre + radius); ++i) {
            mask[first + i * stride] = true;
        }
    }
}

} // namespace

Motion find_motion(const scene::Scene& scene, const scene::ScenePose& before, const scene::ScenePose& now) {
    Motion motion;
    for (const scene::Instance& instance : scene.instances) {
        const glm::mat4& world_from_node = now.world_from_node.at(instance.node);
        const glm::mat4& world_from_node_before = before.world_from_node.at(instance.node);
        // The transforms of nodes at rest are computed from the same numbers, so they are bitwise equal.
        const bool is_moving = world_from_node != world_from_node_before;
        motion.is_moving.push_back(is_moving);
        motion.before_from_now.push_back(is_moving ? world_from_node_before * glm::inverse(world_from_node)
                                                   : glm::mat4(1.0F));
    }
    return motion;
}

std::vector<bool> moving_mask(const image::ViewSurfaces& surfaces, const std::vector<bool>& is_moving,
                              std::uint32_t radius_px) {
    const std::size_t width = surfaces.camera.width_px;
    const std::size_t height = surfaces.camera.height_px;
    std::vector<bool> mask;
    for (const std::uint32_t instance : surfaces.object) {
        mask.push_back(instance != scene::kNone && is_moving.at(instance));
    }
    for (std::size_t y = 0; y < height; ++y) {
        widen(mask, y * width, width, 1, radius_px);
    }
    for (std::size_t x = 0; x < width; ++x) {
        widen(mask, x, height, width, radius_px);
    }
    return mask;
}

} // namespace fieldcast::bench
