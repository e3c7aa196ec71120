// SPDX-License-Identifier: Apache-2.0
#include "core/render/warp/warp_planes.h"

#include "core/render/warp/residual_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fieldcast::render {

namespace {

constexpr std::uint32_t kLeastHoles = 2; // of a tile that is sent; single holes are filled from their neighbours
constexpr float kMostSteps = 65535.0F;
constexpr float kStepsPerPixel = 32.0F; // rounding moves by half a step

float nearest_of(const std::vector<float>& depth_m, float nearest_m) {
    return depth_m.empty() ? nearest_m : std::min(nearest_m, *std::ranges::min_element(depth_m));
}

/// Views of the source's size and field of view.
ViewRequest request_of(const Camera& source, const LatticeGeometry& geometry, std::vector<LatticePosition> positions) {
    return {.geometry = geometry,
            .fovy_rad = vertical_fov(source),
            .width_px = source.width_px,
            .height_px = source.height_px,
            .positions = std::move(positions)};
}

void add_plane(SourceFrame& frame, Plane plane) {
    std::erase_if(frame.planes, [&](const Plane& old) { return old.semantic == plane.semantic; });
    frame.planes.push_back(std::move(plane));
}

} // namespace

std::vector<LatticePosition> residual_positions(const ViewGrid& grid) {
    const std::uint32_t bottom = grid.rows - 1;
    const std::uint32_t right = grid.cols - 1;
    std::vector<LatticePosition> positions;
    for (const auto& [row, col] :
         {std::pair(0U, 0U), std::pair(bottom, right), std::pair(0U, right), std::pair(bottom, 0U)}) {
        const LatticePosition position = lattice_position(grid, row, col);
        if (position != LatticePosition{} && std::ranges::find(positions, position) == positions.end()) {
            positions.push_back(position);
        }
    }
    return positions;
}

float choose_inverse_depth_unit(const Camera& source, const ViewGrid& grid, float nearest_m) {
    float parallax = 0.0F; // of the farthest view, pixels · metres
    for (const LatticePosition position : residual_positions(grid)) {
        const glm::vec2 moved = glm::vec2(position.col(), position.row()) * grid.geometry.spacing_m;
        parallax = std::max(parallax, source.focal_px * std::max(std::abs(moved.x), std::abs(moved.y)));
    }
    const float finest = std::isfinite(nearest_m) ? 1.0F / (nearest_m * kMostSteps) : 1.0F / kMostSteps;
    return parallax > 0.0F ? std::max(finest, 1.0F / (kStepsPerPixel * parallax)) : finest;
}

Plane make_inverse_depth(PlaneSemantic semantic, std::span<const float> depth_m, std::uint32_t width_px, float unit) {
    Plane plane{semantic, PlaneFormat::kR16, width_px, static_cast<std::uint32_t>(depth_m.size() / width_px), {}};
    plane.bytes.resize(depth_m.size() * 2);
    for (std::size_t i = 0; i < depth_m.size(); ++i) {
        const float steps = std::clamp(1.0F / (depth_m[i] * unit) + 0.5F, 0.0F, kMostSteps);
        const auto word = static_cast<std::uint16_t>(steps);
        std::memcpy(&plane.bytes[2 * i], &word, sizeof word);
    }
    return plane;
}

WarpPlanesRenderer::WarpPlanesRenderer(const gpu::Device& device, const scene::GpuScene& scene, GridRenderer& views)
    : readback_(device), views_(views), surfaces_(device, scene), corner_planes_(device), warp_(device) {}

void WarpPlanesRenderer::render(const SourcePlanes& source, const ViewGrid& largest, bool has_residual,
                                SourceFrame& frame) {
    FC_ASSERT(source.source_count() == 1, "views are warped from one source");
    Corners corners = has_residual ? render_corners(source, largest) : Corners{};
    const std::vector<float> depth_m = download_depth(source, corners);
    float nearest_m = nearest_of(depth_m, std::numeric_limits<float>::infinity());
    for (const std::vector<float>& of_corner : corners.depth_m) {
        nearest_m = nearest_of(of_corner, nearest_m);
    }
    FrameHeader& header = frame.header;
    header.inverse_depth_unit = choose_inverse_depth_unit(header.source, largest, nearest_m);
    header.residual = {};
    add_plane(frame, render_colour(source));
    add_plane(frame, make_inverse_depth(PlaneSemantic::kInverseDepth, depth_m, source.camera().width_px,
                                        header.inverse_depth_unit));
    if (has_residual) {
        add_residual(corners, largest, frame);
    }
}

Plane WarpPlanesRenderer::render_colour(const SourcePlanes& source) {
    const FrameHeader& header = source.header();
    const Camera widened = source.camera();
    ViewRequest request = request_of(header.source, header.source_geometry, header.source_positions);
    request.width_px = widened.width_px;
    request.height_px = widened.height_px;
    request.guard_band = header.guard_band;
    return std::move(views_.render(source, request).views.front().image);
}

WarpPlanesRenderer::Corners WarpPlanesRenderer::render_corners(const SourcePlanes& source, const ViewGrid& largest) {
    const std::vector<LatticePosition> positions = residual_positions(largest);
    if (positions.empty()) {
        return {};
    }
    Corners corners{views_.render(source, request_of(source.header().source, largest.geometry, positions)), {}};
    FrameHeader header; // surfaces only: the corner views are rendered as if they were sources
    header.source = source.header().source;
    header.source_positions = positions;
    header.source_geometry = largest.geometry;
    corner_planes_.resize(header);
    surfaces_.render(corner_planes_);
    return corners;
}

// Depth of the source, which is returned, and of the corner views, in one submission.
std::vector<float> WarpPlanesRenderer::download_depth(const SourcePlanes& source, Corners& corners) {
    std::vector<float> depth_m(source.pixel_count());
    std::vector<gpu::ReadbackPart> parts{{.buffer = &source.plane(PlaneSemantic::kDepth),
                                          .bytes = std::as_writable_bytes(std::span(depth_m))}};
    corners.depth_m.assign(corners.views.views.size(), std::vector<float>(corner_planes_.pixel_count()));
    std::uint64_t offset_bytes = 0;
    for (std::vector<float>& of_corner : corners.depth_m) {
        parts.push_back({&corner_planes_.plane(PlaneSemantic::kDepth), offset_bytes,
                         std::as_writable_bytes(std::span(of_corner))});
        offset_bytes += of_corner.size() * sizeof(float);
    }
    readback_.read(std::move(parts));
    return depth_m;
}

// Each corner view adds tiles for what the source and the tiles of earlier views do not show.
void WarpPlanesRenderer::add_residual(const Corners& corners, const ViewGrid& largest, SourceFrame& frame) {
    const Camera camera = frame.header.source;
    const glm::uvec2 size(camera.width_px, camera.height_px);
    const glm::uvec2 tiles_of_view = residual_tiles(size.x, size.y);
    TilePlane colour(PlaneSemantic::kResidualColour, PlaneFormat::kRgb8);
    TilePlane inverse_depth(PlaneSemantic::kResidualInverseDepth, PlaneFormat::kR16);
    ResidualLayer& layer = frame.header.residual;
    layer.geometry = largest.geometry;
    for (std::uint32_t i = 0; i < corners.depth_m.size(); ++i) {
        const View& view = corners.views.views[i];
        const Decoded<void> uploaded = warp_.upload(frame);
        FC_ASSERT(uploaded.has_value(), "planes made here fit their header");
        warp_.render(request_of(camera, largest.geometry, {view.position}));
        std::vector<std::uint32_t> tiles = choose_tiles(warp_.hole_mask(0), size, kLeastHoles);
        tiles.resize(std::min(tiles.size(), max_residual_tiles() - layer.tiles.size()));
        colour.append(view.image, tiles);
        inverse_depth.append(make_inverse_depth(PlaneSemantic::kResidualInverseDepth, corners.depth_m[i], size.x,
                                                frame.header.inverse_depth_unit),
                             tiles);
        layer.positions.push_back(view.position);
        for (const std::uint32_t tile : tiles) {
            layer.tiles.push_back(i * tiles_of_view.x * tiles_of_view.y + tile);
        }
        add_plane(frame, colour.plane());
        add_plane(frame, inverse_depth.plane());
    }
    if (layer.positions.empty()) { // a grid of one view has the promised planes, too
        layer.positions = {LatticePosition{}};
        add_plane(frame, colour.plane());
        add_plane(frame, inverse_depth.plane());
    }
}

} // namespace fieldcast::render
