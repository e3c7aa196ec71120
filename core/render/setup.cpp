// SPDX-License-Identifier: Apache-2.0
#include "core/render/setup.h"

#include "core/render/source/source_renderer.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::render {

namespace {

constexpr std::uint32_t kMeasureHeight = 180; // pixels; the measured band is scaled to the source

/// Depth of every pixel of the source camera widened by `band`.
std::vector<float> trace_depth(const gpu::Device& device, const scene::GpuScene& scene, const Camera& source,
                               const GuardBand& band) {
    FrameHeader header;
    header.source = source;
    header.guard_band = band;
    SourcePlanes planes(device);
    planes.resize(header);
    SurfacePlanesRenderer(device, scene).render(planes);
    return gpu::read_buffer_as<float>(device, planes.plane(PlaneSemantic::kDepth), planes.pixel_count());
}

/// The quantile 1/1000 of the depths; infinity for an empty image.
float nearest_depth(std::vector<float> depth_m) {
    const auto rank = static_cast<std::ptrdiff_t>(depth_m.size() / 1000);
    std::ranges::nth_element(depth_m, depth_m.begin() + rank);
    return depth_m[static_cast<std::size_t>(rank)];
}

std::uint32_t scaled(std::uint32_t pixels, float factor) {
    return static_cast<std::uint32_t>(std::ceil(static_cast<float>(pixels) * factor));
}

} // namespace

GuardBandChoice measure_guard_band(const gpu::Device& device, const scene::GpuScene& scene, const Camera& source,
                                   const ViewGrid& largest, std::span<const LatticePosition> source_positions) {
    if (source_positions.size() != 1) {
        return {};
    }
    const LatticePosition at = source_positions.front();
    const std::uint32_t height = std::min(source.height_px, kMeasureHeight);
    const float factor = static_cast<float>(source.height_px) / static_cast<float>(height);
    const auto width = std::max(1U, static_cast<std::uint32_t>(static_cast<float>(source.width_px) / factor));
    const Camera small =
        moved_camera(make_camera(source.world_from_camera, vertical_fov(source), width, height), largest.geometry, at);
    const float nearest_m = nearest_depth(trace_depth(device, scene, small, {}));
    if (!std::isfinite(nearest_m)) {
        return {};
    }
    const GuardBand widest = widest_guard_band(small, largest, nearest_m, at);
    GuardBandChoice choice = choose_guard_band(small, widest, trace_depth(device, scene, small, widest), largest,
                                               kGuardBandTarget, kGuardBandCap, at);
    choice.band = {scaled(choice.band.left_px, factor), scaled(choice.band.right_px, factor),
                   scaled(choice.band.top_px, factor), scaled(choice.band.bottom_px, factor)};
    return choice;
}

float auto_exposure(GridRenderer& grid_renderer, const SourcePlanes& source) {
    const Camera& camera = source.header().source;
    grid_renderer.render(source, {{}, vertical_fov(camera), camera.width_px, camera.height_px, {LatticePosition{}}});
    const LinearView view = grid_renderer.linear_view(0);
    double sum = 0.0;
    for (const glm::vec3& c : view.pixels) {
        const float luminance = 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
        sum += std::log(static_cast<double>(std::max(luminance, 1e-4F)));
    }
    return static_cast<float>(0.18 / std::exp(sum / static_cast<double>(std::max<std::size_t>(1, view.pixels.size()))));
}

Camera source_camera(const scene::GpuScene& scene, const scene::CameraNode& camera, std::uint32_t width_px,
                     std::uint32_t height_px) {
    return make_camera(camera_pose(scene.current_pose(), camera), camera.fovy_rad, width_px, height_px);
}

} // namespace fieldcast::render
