// SPDX-License-Identifier: Apache-2.0
#include "core/scene/framing.h"

#include "core/scene/studio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <vector>

namespace fieldcast::scene {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Three-quarter view of an object. Its front is +Z (glTF 2.0, section 3.4); the camera stands to the right and above.
constexpr float kYaw = 30.0F * kPi / 180.0F;
constexpr float kElevation = 20.0F * kPi / 180.0F;
constexpr float kObjectFovy = 40.0F * kPi / 180.0F;
constexpr float kMargin = 1.05F; ///< size of the frame over the size of the scene in it

// Rooms.
constexpr float kRoomFovy = 60.0F * kPi / 180.0F;
constexpr int kPlaces = 7;               ///< places to try, in each direction of the floor
constexpr int kProbeRays = 192;          ///< rays per place
constexpr int kAzimuths = 48;            ///< viewing directions to try per place
constexpr float kEnclosed = 0.75F;       ///< least share of rays that hit something
constexpr float kFromWithin = 0.6F;      ///< least share of hits on front sides; inside a solid object it is 0
constexpr float kRoomPlaces = 0.25F;     ///< least share of places that are enclosed
constexpr float kEyeHeight_m = 1.6F;
constexpr float kLowestCeiling_m = 1.9F; ///< a person can stand upright below it
constexpr float kHighestCeiling_m = 60.0F; ///< scenes with higher or lower ceilings are not in metres
constexpr float kEyeShare = 0.45F;       ///< eye height over ceiling height in scenes that are not in metres

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{std::numeric_limits<float>::lowest()};

    void add(const glm::vec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    glm::vec3 centre() const { return 0.5F * (low + high); }
    glm::vec3 size() const { return high - low; }
    std::array<glm::vec3, 8> corners() const {
        std::array<glm::vec3, 8> result{};
        for (unsigned i = 0; i < 8; ++i) {
            result[i] = {(i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z};
        }
        return result;
    }
};

Box bounds_of(const Mesh& mesh) {
    Box box;
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            box.add(mesh.positions[triangle[corner]]);
        }
    }
    return box;
}

/// Points in world space whose convex hull contains the scene: all corners of triangles. If these are very many, the
/// corners of the meshes' bounding boxes replace them.
class Outline {
public:
    Outline(const Scene& scene, const ScenePose& pose) : scene_(scene), pose_(pose) {
        std::uint64_t count = 0;
        for (const Instance& instance : scene.instances) {
            count += 3 * scene.meshes[instance.mesh].triangles.size();
        }
        constexpr std::uint64_t kMostPoints = 30'000'000; // these take a tenth of a second
        if (count > kMostPoints) {
            for (const Mesh& mesh : scene.meshes) {
                boxes_.push_back(bounds_of(mesh));
            }
        }
        for_each([&](const glm::vec3& point) { box_.add(point); });
    }

    const Box& box() const { return box_; }

    template <class Function> void for_each(const Function& function) const {
        for (const Instance& instance : scene_.instances) {
            const Mesh& mesh = scene_.meshes[instance.mesh];
            const glm::mat4& placed = pose_.world_from_node[instance.node];
            const auto visit = [&](const glm::vec3& point) { function(glm::vec3(placed * glm::vec4(point, 1.0F))); };
            if (mesh.triangles.empty()) {
                continue;
            }
            if (!boxes_.empty()) {
                std::ranges::for_each(boxes_[instance.mesh].corners(), visit);
                continue;
            }
            for (const glm::uvec3& triangle : mesh.triangles) {
                visit(mesh.positions[triangle.x]);
                visit(mesh.positions[triangle.y]);
                visit(mesh.positions[triangle.z]);
            }
        }
    }

private:
    const Scene& scene_;
    const ScenePose& pose_;
    std::vector<Box> boxes_; ///< of meshes; empty: corners of triangles are used
    Box box_;
};

/// Direction `i` of `count` that are spread evenly over the sphere (Fibonacci spiral).
glm::vec3 sphere_direction(int i, int count) {
    const float y = 1.0F - 2.0F * (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
    const float angle = static_cast<float>(i) * kPi * (3.0F - std::sqrt(5.0F));
    const float radius = std::sqrt(std::max(0.0F, 1.0F - y * y));
    return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

/// Distance from `from` to the nearest surface, metres; at most `longest`.
float free_distance(const RayProbe& probe, const glm::vec3& from, const glm::vec3& direction, float longest) {
    const auto hit = probe.trace(from, direction);
    return hit ? std::min(hit->distance_m, longest) : longest;
}

/// A camera position in a room.
struct Place {
    glm::vec3 eye{0.0F};
    glm::vec3 direction{0.0F};
    float free_m = 0.0F; ///< free distance in that direction
};

class RoomFinder {
public:
    /// `has_light`: the scene itself has light, apart from its environment.
    RoomFinder(const RayProbe& probe, const Box& box, bool has_light)
        : probe_(probe), box_(box), longest_(glm::length(box.size())), has_light_(has_light) {}

    /// The place with the longest free direction; nothing if the scene is not a room.
    std::optional<Place> best() const {
        std::optional<Place> best;
        int enclosed = 0;
        for (int i = 0; i < kPlaces * kPlaces; ++i) {
            const glm::vec3 eye = eye_at((static_cast<float>(i % kPlaces) + 0.5F) / kPlaces,
                                         (static_cast<float>(i / kPlaces) + 0.5F) / kPlaces);
            if (!is_enclosed(eye)) {
                continue;
            }
            ++enclosed;
            const Place place = looking_far(eye);
            if (!best || place.free_m > best->free_m) {
                best = place;
            }
        }
        return static_cast<float>(enclosed) >= kRoomPlaces * kPlaces * kPlaces ? best : std::nullopt;
    }

private:
    /// Eye position above the floor that lies below the middle of the scene's height.
    glm::vec3 eye_at(float u, float v) const {
        const glm::vec3 size = box_.size();
        const glm::vec3 middle(box_.low.x + u * size.x, box_.centre().y, box_.low.z + v * size.z);
        const float down = free_distance(probe_, middle, {0.0F, -1.0F, 0.0F}, 0.5F * size.y);
        const float up = free_distance(probe_, middle, {0.0F, 1.0F, 0.0F}, 0.5F * size.y);
        const float ceiling = down + up;
        const bool is_metric = ceiling >= kLowestCeiling_m && ceiling <= kHighestCeiling_m;
        const float height = is_metric ? std::min(kEyeHeight_m, 0.8F * ceiling) : kEyeShare * ceiling;
        return {middle.x, middle.y - down + height, middle.z};
    }

    bool is_enclosed(const glm::vec3& eye) const {
        int hits = 0;
        int fronts = 0;
        float nearest = longest_;
        for (int i = 0; i < kProbeRays; ++i) {
            if (const auto hit = probe_.trace(eye, sphere_direction(i, kProbeRays))) {
                ++hits;
                fronts += hit->is_front ? 1 : 0;
                nearest = std::min(nearest, hit->distance_m);
            }
        }
        constexpr float kClearance = 0.01F; // share of the scene's size: the camera must not stand in a wall or a shelf
        const bool is_dark = hits == kProbeRays && !has_light_; // a closed box
        return !is_dark && static_cast<float>(hits) >= kEnclosed * kProbeRays &&
               static_cast<float>(fronts) >= kFromWithin * static_cast<float>(hits) && nearest >= kClearance * longest_;
    }

    /// The direction of greatest free distance, slightly downwards. A mean of a few rays prevents that slits count.
    Place looking_far(const glm::vec3& eye) const {
        Place place{.eye = eye};
        for (int i = 0; i < kAzimuths; ++i) {
            float sum = 0.0F;
            constexpr std::array kOffsets{-0.2F, -0.1F, 0.0F, 0.1F, 0.2F};
            for (const float offset : kOffsets) {
                sum += free_distance(probe_, eye, looking(i, offset), longest_);
            }
            const float mean = sum / static_cast<float>(kOffsets.size());
            if (mean > place.free_m) {
                place.free_m = mean;
                place.direction = looking(i, 0.0F);
            }
        }
        return place;
    }

    static glm::vec3 looking(int azimuth, float offset) {
        const float angle = 2.0F * kPi * static_cast<float>(azimuth) / kAzimuths + offset;
        return glm::normalize(glm::vec3(std::sin(angle), -0.06F, std::cos(angle)));
    }

    const RayProbe& probe_;
    const Box box_;
    const float longest_;
    const bool has_light_;
};

float half_width(float fovy_rad, float aspect) {
    return std::tan(0.5F * fovy_rad) * aspect;
}

glm::quat looking_along(const glm::vec3& direction) {
    const bool is_vertical = std::abs(direction.y) > 0.999F;
    return glm::quatLookAt(direction, is_vertical ? glm::vec3(0.0F, 0.0F, -1.0F) : glm::vec3(0.0F, 1.0F, 0.0F));
}

/// Distance from `at`, in direction `back`, at which the image contains the whole scene.
float fitting_distance(const Outline& outline, const glm::vec3& at, const glm::vec3& back, float fovy_rad,
                       float aspect) {
    const glm::mat3 local_from_world = glm::transpose(glm::mat3_cast(looking_along(-back)));
    const glm::vec2 slopes(half_width(fovy_rad, aspect), half_width(fovy_rad, 1.0F));
    float distance = 0.0F;
    outline.for_each([&](const glm::vec3& point) {
        const glm::vec3 local = local_from_world * (point - at);
        const float needed = std::max(std::abs(local.x) / slopes.x, std::abs(local.y) / slopes.y);
        distance = std::max(distance, kMargin * needed + local.z);
    });
    return distance;
}

Framing object_framing(const Outline& outline, const FramingOptions& options, float aspect) {
    const float fovy_rad = options.fovy_rad.value_or(kObjectFovy);
    const glm::vec3 at = options.look_at.value_or(outline.box().centre());
    const glm::vec3 back(std::sin(kYaw) * std::cos(kElevation), std::sin(kElevation),
                         std::cos(kYaw) * std::cos(kElevation));
    const glm::vec3 from = at + back * fitting_distance(outline, at, back, fovy_rad, aspect);
    return {.from = options.look_from.value_or(from), .at = at, .fovy_rad = fovy_rad};
}

Framing room_framing(const Place& place, const FramingOptions& options) {
    return {.from = place.eye,
            .at = place.eye + place.free_m * place.direction,
            .fovy_rad = options.fovy_rad.value_or(kRoomFovy),
            .is_inside = true};
}

} // namespace

std::pair<glm::vec3, glm::vec3> extent_of(const Scene& scene) {
    const ScenePose pose = pose_scene(scene, 0);
    const Box box = Outline(scene, pose).box();
    return {box.low, box.high};
}

Framing find_framing(const Scene& scene, const RayProbe& probe, const FramingOptions& options, float aspect) {
    const ScenePose pose = pose_scene(scene, 0);
    const Outline outline(scene, pose);
    const Box& box = outline.box();
    const bool is_open = !options.look_from && !options.look_at && !options.orbit_s;
    const auto place = is_open ? RoomFinder(probe, box, has_light(scene)).best() : std::nullopt;
    Framing framing = place ? room_framing(*place, options) : object_framing(outline, options, aspect);
    const float least = std::max(1e-6F, 1e-4F * glm::length(box.size()));
    if (glm::distance(framing.from, framing.at) < least) { // a scene of one point, or look_from equals look_at
        framing.at = framing.from + glm::vec3(0.0F, 0.0F, -least);
    }
    return framing;
}

void add_camera(Scene& scene, const Framing& framing, std::optional<double> orbit_s) {
    const glm::quat rotation = looking_along(glm::normalize(framing.at - framing.from));
    const bool orbits = orbit_s.has_value();
    const auto pivot = static_cast<std::uint32_t>(scene.nodes.size());
    Node centre;
    centre.name = "auto pivot";
    centre.translation = framing.at;
    centre.is_animated = orbits;
    Node camera;
    camera.name = kFramingCamera;
    camera.parent = pivot;
    camera.translation = framing.from - framing.at;
    camera.rotation = rotation;
    camera.is_animated = orbits;
    scene.nodes.push_back(std::move(centre));
    scene.nodes.push_back(std::move(camera));
    scene.cameras.push_back({.name = kFramingCamera, .node = pivot + 1, .fovy_rad = framing.fovy_rad, .spacing_m = {}});
    if (!orbits) {
        return;
    }
    scene.duration_s = std::max(scene.duration_s, *orbit_s);
    const int turns = std::max(1, static_cast<int>(std::lround(scene.duration_s / *orbit_s)));
    constexpr int kKeysPerTurn = 4;
    AnimationChannel channel{.node = pivot, .path = AnimationPath::kRotation, .times_s = {}, .values = {}};
    for (int key = 0; key <= turns * kKeysPerTurn; ++key) {
        const float angle = 2.0F * kPi * static_cast<float>(key) / kKeysPerTurn;
        channel.times_s.push_back(static_cast<float>(scene.duration_s * key / (turns * kKeysPerTurn)));
        channel.values.emplace_back(0.0F, std::sin(0.5F * angle), 0.0F, std::cos(0.5F * angle));
    }
    scene.channels.push_back(std::move(channel));
}

std::optional<DepthRange> depth_range(const RayProbe& probe, const glm::mat4& world_from_camera, float fovy_rad,
                                      float aspect) {
    constexpr int kCols = 48;
    constexpr int kRows = 27;
    const glm::mat3 axes(world_from_camera);
    std::vector<float> depths;
    for (int i = 0; i < kCols * kRows; ++i) {
        const float x = 2.0F * (static_cast<float>(i % kCols) + 0.5F) / kCols - 1.0F;
        const float y = 2.0F * (static_cast<float>(i / kCols) + 0.5F) / kRows - 1.0F;
        const glm::vec3 local = glm::normalize(
            glm::vec3(x * half_width(fovy_rad, aspect), y * half_width(fovy_rad, 1.0F), -1.0F));
        const auto hit = probe.trace(glm::vec3(world_from_camera[3]), axes * local);
        if (hit && hit->distance_m > 0.0F) { // a camera that lies in a surface does not see it
            depths.push_back(hit->distance_m * -local.z);
        }
    }
    if (depths.size() * 20 < kCols * kRows) {
        return std::nullopt;
    }
    std::ranges::sort(depths);
    const auto at = [&](double share) {
        return depths[static_cast<std::size_t>(share * static_cast<double>(depths.size() - 1))];
    };
    return DepthRange{.near_m = at(0.05), .middle_m = at(0.5), .far_m = at(0.95)};
}

// Disparity between neighbouring views, in widths, is spacing / (2 tan(fovx / 2)) · |1 / depth - 1 / convergence|
// (docs/lightfield.md, "Cameras").
float comfortable_spacing(const DepthRange& depths, float convergence_m, std::uint32_t count, float fovy_rad,
                          float aspect) {
    if (count < 2) {
        return 0.0F;
    }
    const float zero = 1.0F / convergence_m;
    const float largest = std::max(std::abs(1.0F / depths.near_m - zero), std::abs(1.0F / depths.far_m - zero));
    const float flat = 0.02F / depths.near_m; // limits the spacing if all depths are equal
    const float sky = zero / 3.0F;            // points at infinity may have three times the disparity
    return kComfortableDisparity * 2.0F * half_width(fovy_rad, aspect) /
           (static_cast<float>(count - 1) * std::max({largest, flat, sky}));
}

} // namespace fieldcast::scene
