// SPDX-License-Identifier: Apache-2.0
#include "bench/speed/embree_tracer.h"

#include "core/base/error.h"
#include "core/scene/bvh_embree.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <immintrin.h>
#include <thread>
#include <vector>

namespace fieldcast::bench {

namespace {

constexpr std::size_t kChunk = 4096;

/// Flushes denormals in a tracing thread, as Embree recommends.
class FlushDenormals {
public:
    FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040U); }
    ~FlushDenormals() { _mm_setcsr(before_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned int before_;
};

#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& query) {
    rtcIntersect1(scene, &query, nullptr);
}
void occlude(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray, nullptr);
}
#else
void intersect(RTCScene scene, RTCRayHit& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
}
void occlude(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}
#endif

RTCRay to_embree(const shared::TraceRay& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x;
    out.org_y = ray.origin.y;
    out.org_z = ray.origin.z;
    out.tnear = ray.t_min;
    out.dir_x = ray.direction.x;
    out.dir_y = ray.direction.y;
    out.dir_z = ray.direction.z;
    out.tfar = ray.t_max;
    out.mask = 0xFFFFFFFFU;
    return out;
}

/// Runs `work(first, end)` over chunks of `count` items on `threads` threads. Returns seconds.
template <class Work> double in_chunks(std::size_t count, std::uint32_t threads, const Work& work) {
    std::atomic<std::size_t> next = 0;
    const auto start = std::chrono::steady_clock::now();
    {
        std::vector<std::jthread> workers;
        for (std::uint32_t i = 0; i < threads; ++i) {
            workers.emplace_back([&] {
                const FlushDenormals flush;
                for (std::size_t first = next.fetch_add(kChunk); first < count; first = next.fetch_add(kChunk)) {
                    work(first, std::min(first + kChunk, count));
                }
            });
        }
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

struct EmbreeTracer::State {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    std::vector<std::uint32_t> instance_of_geometry;

    ~State() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void add(const scene::Mesh& mesh, const glm::mat4& world_from_object, std::uint32_t instance) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
        std::transform(mesh.positions.begin(), mesh.positions.end(), positions,
                       [&](const glm::vec3& p) { return glm::vec3(world_from_object * glm::vec4(p, 1.0F)); });
        auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
        rtcCommitGeometry(geometry);
        const unsigned int id = rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        instance_of_geometry.resize(std::max<std::size_t>(instance_of_geometry.size(), id + 1));
        instance_of_geometry[id] = instance;
    }
};

EmbreeTracer::EmbreeTracer(const scene::Scene& scene, const scene::ScenePose& pose) : state_(new State) {
    FC_ASSERT(state_->device != nullptr, "Embree failed to start");
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const scene::Instance& instance = scene.instances[i];
        if (!scene.meshes[instance.mesh].triangles.empty()) {
            state_->add(scene.meshes[instance.mesh], pose.world_from_node[instance.node], i);
        }
    }
    rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(state_->scene);
}

EmbreeTracer::~EmbreeTracer() = default;

SurfaceHit EmbreeTracer::closest(const shared::TraceRay& ray) const {
    RTCRayHit query{to_embree(ray), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(state_->scene, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return {ray.t_max};
    }
    return {query.ray.tfar, state_->instance_of_geometry[query.hit.geomID], query.hit.primID,
            glm::normalize(glm::vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z))};
}

double EmbreeTracer::trace_closest(std::span<const shared::TraceRay> rays, std::span<shared::TraceHit> hits,
                                   std::uint32_t threads) const {
    return in_chunks(rays.size(), threads, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            RTCRayHit query{to_embree(rays[i]), {}};
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            intersect(state_->scene, query);
            const bool is_hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            hits[i] = {query.ray.tfar, is_hit ? state_->instance_of_geometry[query.hit.geomID] : scene::kNone,
                       query.hit.primID};
        }
    });
}

double EmbreeTracer::trace_any(std::span<const shared::TraceRay> rays, std::span<float> transmittances,
                               std::uint32_t threads) const {
    return in_chunks(rays.size(), threads, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            RTCRay ray = to_embree(rays[i]);
            occlude(state_->scene, ray);
            transmittances[i] = ray.tfar < 0.0F ? 0.0F : 1.0F;
        }
    });
}

} // namespace fieldcast::bench
