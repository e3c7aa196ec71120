// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/drawn_visibility.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "core/render/view_request.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/scene.h"

#include <algorithm>
#include <array>

namespace fieldcast::render {

namespace {

constexpr std::uint32_t kViewsAtOnce = 8;  // bounds the memory of the target
constexpr double kPixelsPerTriangle = 0.5; // with fewer, rays are faster; measured on epyc2
constexpr std::array kDrawOrder = {scene::AlphaMode::kOpaque, scene::AlphaMode::kMask, scene::AlphaMode::kBlend};
constexpr float kNearOfRadius = 1e-4F; // the depth buffer holds floats of near / depth: its precision hardly depends

/// All of a batch have the size of its first.
std::uint64_t batch_stride(const VisibilityBatch& batch) {
    const Camera& camera = batch.cameras.front();
    return view_stride(camera.width_px, camera.height_px);
}

/// Vulkan's clip space of a pinhole, looking along −Z: x right, y down, z / w = near / depth.
glm::mat4 clip_from_world(const Camera& camera, float near_m) {
    const auto width = static_cast<float>(camera.width_px);
    const auto height = static_cast<float>(camera.height_px);
    glm::mat4 clip(0.0F);
    clip[0][0] = 2.0F * camera.focal_px / width;
    clip[1][1] = -2.0F * camera.focal_px / height;
    clip[2][0] = 1.0F - 2.0F * camera.principal_px.x / width; // depth = −Z
    clip[2][1] = 1.0F - 2.0F * camera.principal_px.y / height;
    clip[2][3] = -1.0F;
    clip[3][2] = near_m;
    return clip * glm::inverse(camera.world_from_camera);
}

/// The planes of a view in the space of a group: outside is negative.
struct ClipPlanes {
    explicit ClipPlanes(const glm::mat4& clip_from_group) {
        const glm::mat4 rows = glm::transpose(clip_from_group);
        planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3] - rows[2]};
    }

    bool may_show(const scene::TriangleCluster& cluster) const {
        return std::ranges::all_of(planes, [&](const glm::vec4& plane) {
            const glm::vec3 normal(plane);
            return glm::dot(normal, cluster.centre) + plane.w + glm::dot(glm::abs(normal), cluster.half_size) >= 0.0F;
        });
    }

    std::array<glm::vec4, 5> planes;
};

/// Those that may be in the picture, as few times as possible: what follows each other is drawn at once.
void draw_clusters(gpu::RasterPass& pass, const std::vector<scene::TriangleCluster>& clusters,
                   const glm::mat4& clip_from_group) {
    const ClipPlanes planes(clip_from_group);
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    for (const scene::TriangleCluster& cluster : clusters) {
        if (planes.may_show(cluster)) {
            first = count == 0 ? cluster.first_index : first;
            count += cluster.index_count;
        } else if (count > 0) {
            pass.draw(first, count);
            count = 0;
        }
    }
    if (count > 0) {
        pass.draw(first, count);
    }
}

const std::vector<scene::TriangleCluster>& clusters_of(const scene::DrawGroup& group, scene::AlphaMode mode) {
    return group.clusters[static_cast<std::size_t>(mode)];
}

} // namespace

DrawnVisibility::DrawnVisibility(const gpu::Device& device, const scene::GpuScene& scene,
                                 const scene::DrawGeometry& geometry)
    : device_(device), scene_(scene), geometry_(geometry),
      near_m_(kNearOfRadius * scene.radius_m()), formats_{VK_FORMAT_R32_UINT},
      name_triangles_(make_plain_kernel(device, KernelId::kNameTriangles, sizeof(shared::NameTrianglesParams))) {
    if (scene.has_blend()) {
        formats_.push_back(VK_FORMAT_R8_UINT);
        find_layers_ = make_scene_kernel(device, scene, KernelId::kFindLayers, sizeof(shared::FindLayersParams));
    }
    for (const scene::AlphaMode mode : kDrawOrder) {
        const auto has_some = [&](const scene::DrawGroup& group) { return !clusters_of(group, mode).empty(); };
        if (std::ranges::any_of(geometry.groups(), has_some)) {
            pipelines_.emplace_back(mode, make_pipeline(mode));
        }
    }
}

std::unique_ptr<gpu::RasterPipeline> DrawnVisibility::make_pipeline(scene::AlphaMode mode) const {
    const bool is_blend = mode == scene::AlphaMode::kBlend;
    gpu::RasterPipelineDesc desc;
    desc.layout = {{&scene_.layout()}, sizeof(shared::DrawParams)};
    desc.vertex = {{VK_FORMAT_R32G32B32A32_UINT, 0}};
    desc.vertex_bytes = sizeof(scene::DrawVertex);
    desc.colours = formats_;
    desc.written = is_blend ? 2U : 1U;
    desc.writes_depth = !is_blend;
    std::vector<gpu::Specialisation> specialisations = scene_.specialisations();
    specialisations.push_back({shared::kSpecialiseMask, mode == scene::AlphaMode::kMask ? 1U : 0U});
    const gpu::RasterCode code = raster_code(is_blend ? RasterId::kDrawBlend : RasterId::kDrawVisibility);
    return std::make_unique<gpu::RasterPipeline>(device_, code, desc, specialisations);
}

void DrawnVisibility::resize(const VisibilityBatch& batch) {
    const Camera& camera = batch.cameras.front();
    const auto count = static_cast<std::uint32_t>(batch.cameras.size());
    const gpu::RasterTargetDesc& have = target_.desc();
    const std::uint32_t layers = std::min(count, kViewsAtOnce);
    if (have.colours.empty() || have.width_px != camera.width_px || have.height_px != camera.height_px ||
        have.layers < layers) {
        target_ = {}; // frees memory first
        target_ = gpu::RasterTarget(device_, {camera.width_px, camera.height_px, layers, formats_});
    }
    const std::uint64_t pixels = batch_stride(batch) * count;
    if (numbers_.size_bytes() < pixels * 4) {
        numbers_ = gpu::Buffer(device_, pixels * 4);
        marks_ = find_layers_ ? gpu::Buffer(device_, pixels) : gpu::Buffer();
    }
}

// Of a view, rays take time for each pixel and drawing for each triangle (docs/measurements/frame_time.md#visibility-of-views).
bool DrawnVisibility::is_fast(const VisibilityBatch& batch) const {
    const Camera& camera = batch.cameras.front();
    const glm::mat4 clip = clip_from_world(camera, near_m_);
    std::uint64_t indices = 0;
    for (const scene::DrawGroup& group : geometry_.groups()) {
        const ClipPlanes planes(clip_from_group(clip, group));
        for (const auto& clusters : group.clusters) {
            for (const scene::TriangleCluster& cluster : clusters) {
                indices += planes.may_show(cluster) ? cluster.index_count : 0;
            }
        }
    }
    const double triangles = static_cast<double>(indices) / 3.0;
    return static_cast<double>(camera.width_px) * camera.height_px >= kPixelsPerTriangle * triangles;
}

glm::mat4 DrawnVisibility::clip_from_group(const glm::mat4& clip_from_world, const scene::DrawGroup& group) const {
    const auto& nodes = scene_.current_pose().world_from_node;
    return group.node == scene::kNone ? clip_from_world : clip_from_world * nodes[group.node];
}

void DrawnVisibility::record(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) {
    resize(batch);
    const std::uint64_t pixels = batch_stride(batch);
    for (std::size_t first = 0; first < batch.cameras.size(); first += kViewsAtOnce) {
        const auto count =
            static_cast<std::uint32_t>(std::min<std::size_t>(kViewsAtOnce, batch.cameras.size() - first));
        target_.begin(recorder);
        for (std::uint32_t layer = 0; layer < count; ++layer) {
            draw_view(recorder, batch, first + layer, layer);
        }
        target_.copy_to(recorder, 0, numbers_, first * pixels * 4, pixels * 4, count);
        if (find_layers_) {
            target_.copy_to(recorder, 1, marks_, first * pixels, pixels, count);
        }
    }
    recorder.barrier();
    name_triangles(recorder, batch);
    if (find_layers_) {
        recorder.barrier();
        find_layers(recorder, batch);
    }
}

void DrawnVisibility::draw_view(gpu::CommandRecorder& recorder, const VisibilityBatch& batch, std::size_t view,
                                std::uint32_t layer) const {
    const glm::mat4 clip = clip_from_world(batch.cameras[view], near_m_);
    gpu::RasterPass pass(recorder, target_, layer);
    pass.use_triangles(geometry_.vertices(), geometry_.indices());
    for (const auto& [mode, pipeline] : pipelines_) {
        pass.use(*pipeline, {&scene_.bindings()});
        for (const scene::DrawGroup& group : geometry_.groups()) {
            const auto& clusters = clusters_of(group, mode);
            if (clusters.empty()) {
                continue;
            }
            shared::DrawParams params{};
            params.clip_from_group = clip_from_group(clip, group);
            params.camera = batch.camera_records + view * sizeof(shared::CameraRecord);
            params.triangles = geometry_.triangles().address();
            pass.push(params);
            draw_clusters(pass, clusters, params.clip_from_group);
        }
    }
}

void DrawnVisibility::name_triangles(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) const {
    shared::NameTrianglesParams params{};
    params.numbers = numbers_.address();
    params.triangles = geometry_.triangles().address();
    params.visibility = batch.visibility->address();
    params.pixel_count = static_cast<std::uint32_t>(batch_stride(batch) * batch.cameras.size());
    params.triangle_count = geometry_.triangle_count();
    recorder.dispatch(name_triangles_, {}, params, linear_groups(params.pixel_count));
}

void DrawnVisibility::find_layers(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) const {
    shared::FindLayersParams params{};
    params.cameras = batch.camera_records;
    params.visibility = batch.visibility->address();
    params.layers = batch.layers->address();
    params.marks = marks_.address();
    params.width = batch.cameras.front().width_px;
    params.height = batch.cameras.front().height_px;
    recorder.dispatch(*find_layers_, {&scene_.bindings()}, params,
                      {gpu::groups_for(params.width, 8), gpu::groups_for(params.height, 8),
                       static_cast<std::uint32_t>(batch.cameras.size())});
}

} // namespace fieldcast::render
