// SPDX-License-Identifier: Apache-2.0
#include "core/scene/ray_probe.h"

#include "core/base/error.h"
#include "core/scene/bvh_embree.h"

#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace fieldcast::scene {

namespace {

/// Owns an Embree object.
template <class Handle, void (*kRelease)(Handle)> class Owned {
public:
    Owned() = default;
    explicit Owned(Handle handle) : handle_(handle) {}
    ~Owned() {
        if (handle_ != nullptr) {
            kRelease(handle_);
        }
    }
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }

    Handle get() const { return handle_; }

private:
    Handle handle_ = nullptr;
};

using OwnedDevice = Owned<RTCDevice, rtcReleaseDevice>;
using OwnedScene = Owned<RTCScene, rtcReleaseScene>;
using OwnedGeometry = Owned<RTCGeometry, rtcReleaseGeometry>;

template <class Element>
void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<Element>& elements) {
    void* const buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), elements.size());
    FC_ASSERT(buffer != nullptr, "no memory for the probe's triangles");
    std::memcpy(buffer, elements.data(), elements.size() * sizeof(Element));
}

OwnedScene scene_of(RTCDevice device, const Mesh& mesh) {
    OwnedScene scene(rtcNewScene(device));
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_COMPACT);
    const OwnedGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    fill(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    fill(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene.get(), geometry.get());
    rtcCommitScene(scene.get());
    return scene;
}

void intersect(RTCScene scene, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
#endif
}

} // namespace

struct RayProbe::State {
    OwnedDevice device{rtcNewDevice(nullptr)};
    std::vector<OwnedScene> meshes; ///< indexed as in the scene; empty for meshes that are not shown
    std::vector<glm::mat3> world_from_object; ///< transforms of directions, per instance
    OwnedScene scene;
};

RayProbe::RayProbe(const Scene& scene, const ScenePose& pose) : state_(std::make_unique<State>()) {
    FC_ASSERT(state_->device.get() != nullptr, "Embree has no device");
    const RTCDevice device = state_->device.get();
    state_->scene = OwnedScene(rtcNewScene(device));
    state_->meshes.resize(scene.meshes.size());
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const glm::mat4& placed = pose.world_from_node[instance.node];
        state_->world_from_object.push_back(glm::mat3(placed));
        if (mesh.triangles.empty()) {
            continue;
        }
        OwnedScene& shown = state_->meshes[instance.mesh];
        if (shown.get() == nullptr) {
            shown = scene_of(device, mesh);
        }
        const OwnedGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
        rtcSetGeometryInstancedScene(geometry.get(), shown.get());
        rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &placed);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(state_->scene.get(), geometry.get(),
                              static_cast<unsigned>(state_->world_from_object.size() - 1));
    }
    rtcCommitScene(state_->scene.get());
}

RayProbe::~RayProbe() = default;

std::optional<ProbeHit> RayProbe::trace(const glm::vec3& from, const glm::vec3& direction) const {
    RTCRayHit ray{};
    ray.ray.org_x = from.x;
    ray.ray.org_y = from.y;
    ray.ray.org_z = from.z;
    ray.ray.dir_x = direction.x;
    ray.ray.dir_y = direction.y;
    ray.ray.dir_z = direction.z;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(state_->scene.get(), ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return std::nullopt;
    }
    // Embree's normal is in object space, so the direction is transformed there. A mirroring transform reverses the
    // winding, and glTF then defines the other side as the front.
    const glm::mat3& world_from_object = state_->world_from_object[ray.hit.instID[0]];
    const glm::vec3 normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    const glm::vec3 local = glm::inverse(world_from_object) * direction;
    return ProbeHit{.distance_m = ray.ray.tfar, .is_front = glm::dot(normal, local) < 0.0F};
}

} // namespace fieldcast::scene
