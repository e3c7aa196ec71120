// SPDX-License-Identifier: Apache-2.0
#include "core/image/correspondence.h"

#include "core/base/error.h"

#include <array>
#include <cmath>

namespace fieldcast::image {

namespace {

constexpr float kDepthTolerance = 0.01F;
constexpr float kRounding_px = 1e-3F; // of projected places: a camera at rest must see each pixel at its own centre

/// The four pixels around a place, and their bilinear weights.
struct Taps {
    std::array<std::size_t, 4> index{};
    std::array<float, 4> weight{};
};

/// Empty if `place` lies outside the centres of the outermost pixels.
std::optional<Taps> taps_around(std::uint32_t width, std::uint32_t height, glm::vec2 place) {
    const glm::vec2 last(static_cast<float>(width - 1), static_cast<float>(height - 1));
    const glm::vec2 corner = glm::clamp(place - 0.5F, glm::vec2(0.0F), last);
    if (!(glm::distance(corner, place - 0.5F) <= kRounding_px)) {
        return std::nullopt;
    }
    const auto x = static_cast<std::size_t>(corner.x);
    const auto y = static_cast<std::size_t>(corner.y);
    const std::size_t right = std::min<std::size_t>(x + 1, width - 1);
    const std::size_t below = std::min<std::size_t>(y + 1, height - 1);
    const glm::vec2 f = glm::fract(corner);
    return Taps{{y * width + x, y * width + right, below * width + x, below * width + right},
                {(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y}};
}

float inverse_depth(const ViewSurfaces& view, std::size_t pixel) {
    return 1.0F / view.depth_m[pixel]; // 0 where nothing was hit
}

/// Place and inverse depth, in `source`, of the point that `pixel` of `target` shows.
struct Seen {
    glm::vec2 place;
    float inverse_depth;
};

Seen seen_from(const ViewSurfaces& target, std::size_t pixel, const Camera& source,
               const std::vector<glm::mat4>& source_from_target) {
    const std::size_t width = target.camera.width_px;
    const glm::vec2 centre(static_cast<float>(pixel % width) + 0.5F, static_cast<float>(pixel / width) + 0.5F);
    if (std::isinf(target.depth_m[pixel])) { // infinitely far: only the direction counts
        const glm::vec3 direction =
            unproject(target.camera, centre, 1.0F) - glm::vec3(target.camera.world_from_camera[3]);
        const glm::vec3 there = project(source, glm::vec3(source.world_from_camera[3]) + direction);
        return {glm::vec2(there), there.z > 0.0F ? 0.0F : -1.0F};
    }
    glm::vec3 world = unproject(target.camera, centre, target.depth_m[pixel]);
    if (!source_from_target.empty()) {
        world = glm::vec3(source_from_target.at(target.object[pixel]) * glm::vec4(world, 1.0F));
    }
    const glm::vec3 there = project(source, world);
    return {glm::vec2(there), 1.0F / there.z};
}

bool is_visible(const ViewSurfaces& source, const Taps& taps, std::uint32_t object, float expected) {
    float found = 0.0F;
    for (std::size_t i = 0; i < taps.index.size(); ++i) {
        if (taps.weight[i] < kRounding_px) {
            continue;
        }
        if (source.object[taps.index[i]] != object) {
            return false;
        }
        found += taps.weight[i] * inverse_depth(source, taps.index[i]);
    }
    return expected >= 0.0F && std::abs(found - expected) <= kDepthTolerance * expected;
}

void check(const ViewSurfaces& view) {
    const std::size_t count = static_cast<std::size_t>(view.camera.width_px) * view.camera.height_px;
    FC_ASSERT(count > 0 && view.depth_m.size() == count && view.object.size() == count, "a view has all its pixels");
}

} // namespace

Correspondence find_correspondence(const ViewSurfaces& target, const ViewSurfaces& source,
                                   const std::vector<glm::mat4>& source_from_target) {
    check(target);
    check(source);
    FC_ASSERT(target.depth_m.size() == source.depth_m.size(), "views have one size");
    Correspondence map{target.camera.width_px, target.camera.height_px, {}};
    map.place.resize(target.depth_m.size());
    for (std::size_t i = 0; i < map.place.size(); ++i) {
        const Seen seen = seen_from(target, i, source.camera, source_from_target);
        const auto taps = taps_around(map.width_px, map.height_px, seen.place);
        if (taps && is_visible(source, *taps, target.object[i], seen.inverse_depth)) {
            map.place[i] = seen.place;
        }
    }
    return map;
}

glm::vec3 sample_bilinear(const RgbF32& image, glm::vec2 place) {
    const auto taps = taps_around(image.width_px, image.height_px, place);
    FC_ASSERT(taps, "place lies within the image");
    glm::vec3 sum(0.0F);
    for (std::size_t i = 0; i < taps->index.size(); ++i) {
        sum += taps->weight[i] * image.pixels[taps->index[i]];
    }
    return sum;
}

std::optional<double> warped_difference(const RgbF32& target, const RgbF32& source, const Correspondence& map) {
    FC_ASSERT(target.pixels.size() == map.place.size() && source.pixels.size() == map.place.size(),
              "images are those of the views");
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < map.place.size(); ++i) {
        if (map.place[i]) {
            const glm::vec3 difference = glm::abs(target.pixels[i] - sample_bilinear(source, *map.place[i]));
            sum += static_cast<double>(difference.x + difference.y + difference.z);
            count += 3.0;
        }
    }
    return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

RgbF32 error_image(const RgbF32& image, const RgbF32& reference) {
    FC_ASSERT(image.pixels.size() == reference.pixels.size(), "images have one size");
    RgbF32 result = image;
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        result.pixels[i] -= reference.pixels[i];
    }
    return result;
}

} // namespace fieldcast::image
