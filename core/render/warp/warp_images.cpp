// SPDX-License-Identifier: Apache-2.0
#include "core/render/warp/warp_images.h"

#include "core/render/kernels.h"

#include <algorithm>
#include <cstring>

namespace fieldcast::render {

namespace {

constexpr std::uint32_t kNothingKnown = 0xBF800000; // the bits of the float −1

Decoded<const Plane*> find_plane(const SourceFrame& frame, PlaneSemantic semantic, const char* name) {
    const Plane* plane = frame.find(semantic);
    if (plane == nullptr) {
        return decode_error(std::string("frame has no plane ") + name);
    }
    const bool fits = plane->format == usual_format(semantic) &&
                      plane->width_px == plane_width(frame.header, semantic) &&
                      plane->height_px == plane_height(frame.header, semantic) &&
                      plane->bytes.size() == plane_bytes(plane->format, plane->width_px, plane->height_px);
    return fits ? Decoded<const Plane*>(plane)
                : decode_error(std::string("plane ") + name + ": format or size does not match the header");
}

/// The planes of a frame from which views are warped.
struct Planes {
    const Plane* colour = nullptr;
    const Plane* inverse_depth = nullptr;
    const Plane* residual_colour = nullptr; ///< null: the frame has no residual layer
    const Plane* residual_inverse_depth = nullptr;
};

Decoded<void> find_residual(const SourceFrame& frame, Planes& planes) {
    const auto colour = find_plane(frame, PlaneSemantic::kResidualColour, "RESIDUAL_COLOUR");
    const auto depth = find_plane(frame, PlaneSemantic::kResidualInverseDepth, "RESIDUAL_INVERSE_DEPTH");
    if (!colour || !depth) {
        return tl::unexpected(colour ? depth.error() : colour.error());
    }
    planes.residual_colour = *colour;
    planes.residual_inverse_depth = *depth;
    return {};
}

Decoded<Planes> find_planes(const SourceFrame& frame) {
    if (frame.header.source_positions.size() != 1) {
        return decode_error("frame has " + std::to_string(frame.header.source_positions.size()) +
                            " sources; views are warped from exactly one");
    }
    if (!(frame.header.inverse_depth_unit > 0.0F)) {
        return decode_error("header.inverse_depth_unit: must be above 0");
    }
    const auto colour = find_plane(frame, PlaneSemantic::kColour, "COLOUR");
    const auto depth = find_plane(frame, PlaneSemantic::kInverseDepth, "INVERSE_DEPTH");
    if (!colour || !depth) {
        return tl::unexpected(colour ? depth.error() : colour.error());
    }
    Planes planes{*colour, *depth};
    if (!frame.header.residual.positions.empty() && !frame.header.residual.tiles.empty()) {
        if (const auto found = find_residual(frame, planes); !found) {
            return tl::unexpected(found.error());
        }
    }
    return planes;
}

std::vector<std::uint16_t> steps_of(const Plane& inverse_depth) {
    std::vector<std::uint16_t> steps(inverse_depth.bytes.size() / 2);
    std::memcpy(steps.data(), inverse_depth.bytes.data(), steps.size() * 2);
    return steps;
}

/// Least and greatest inverse depth, in steps of inverse_depth_unit; the first is larger if the range is empty.
using StepRange = std::pair<std::uint16_t, std::uint16_t>;
constexpr StepRange kNoSteps{0xFFFF, 0};

void widen(StepRange& range, std::span<const std::uint16_t> steps) {
    for (const std::uint16_t step : steps) {
        range = {std::min(range.first, step), std::max(range.second, step)};
    }
}

/// The range of every image: the source, then the views of the residual layer.
std::vector<StepRange> depth_ranges(const SourceFrame& frame, const ResidualLayer& residual) {
    std::vector<StepRange> ranges(1 + residual.positions.size(), kNoSteps);
    widen(ranges[0], steps_of(*frame.find(PlaneSemantic::kInverseDepth)));
    if (residual.tiles.empty()) {
        return ranges;
    }
    const std::vector<std::uint16_t> steps = steps_of(*frame.find(PlaneSemantic::kResidualInverseDepth));
    const glm::uvec2 tiles = residual_tiles(frame.header.source.width_px, frame.header.source.height_px);
    for (std::size_t slot = 0; slot < residual.tiles.size(); ++slot) {
        constexpr std::size_t kWidth = kResidualColumns * kResidualTile;
        const std::size_t corner =
            slot / kResidualColumns * kResidualTile * kWidth + slot % kResidualColumns * kResidualTile;
        for (std::uint32_t row = 0; row < kResidualTile; ++row) {
            widen(ranges[1 + residual.tiles[slot] / (tiles.x * tiles.y)],
                  std::span(steps).subspan(corner + row * kWidth, kResidualTile));
        }
    }
    return ranges;
}

std::uint32_t blocks_of(const shared::WarpImage& image, std::uint32_t side) {
    return gpu::groups_for(image.width, side) * gpu::groups_for(image.height, side);
}

} // namespace

WarpImages::WarpImages(const gpu::Device& device)
    : device_(device), recorder_(device), layout_(device, {{shared::kWarpTexels, gpu::BindingType::kTexelBuffer, 1},
                                                           {shared::kWarpBlocks, gpu::BindingType::kTexelBuffer, 1},
                                                           {shared::kWarpCoarse, gpu::BindingType::kTexelBuffer, 1}}),
      unpack_(make_plain_kernel(device, KernelId::kWarpUnpack, sizeof(shared::WarpUnpackParams))),
      link_(make_plain_kernel(device, KernelId::kWarpLink, sizeof(shared::WarpLinkParams))),
      bounds_(make_plain_kernel(device, KernelId::kWarpBounds, sizeof(shared::WarpBoundsParams))) {}

Decoded<void> WarpImages::upload(const SourceFrame& frame) {
    const auto planes = find_planes(frame);
    if (!planes) {
        return tl::unexpected(planes.error());
    }
    const bool has_residual = planes->residual_colour != nullptr;
    header_ = frame.header;
    if (!has_residual) {
        header_.residual = {};
    }
    reserve(place_images(frame));
    gpu::write_buffer(device_, records_, std::as_bytes(std::span(images_)));
    recorder_.fill(texels_, kNothingKnown);
    recorder_.barrier();
    record_unpack(*planes->colour, *planes->inverse_depth, 0);
    if (has_residual) {
        recorder_.submit(); // kernels must read the previous upload before it is replaced
        tiles_ = gpu::make_buffer<std::uint32_t>(device_, header_.residual.tiles);
        record_unpack(*planes->residual_colour, *planes->residual_inverse_depth,
                      static_cast<std::uint32_t>(header_.residual.tiles.size()));
    }
    record_links();
    record_bounds();
    recorder_.submit();
    return {};
}

WarpImages::Room WarpImages::place_images(const SourceFrame& frame) {
    cameras_ = {widened_source(header_, 0)};
    for (const LatticePosition position : header_.residual.positions) {
        cameras_.push_back(moved_camera(header_.source, header_.residual.geometry, position));
    }
    const std::vector<StepRange> ranges = depth_ranges(frame, header_.residual);
    images_.clear();
    Room room;
    for (const Camera& camera : cameras_) {
        const StepRange range = ranges[images_.size()];
        const shared::WarpImage image{.first_texel = room.texels,
                                      .width = camera.width_px,
                                      .height = camera.height_px,
                                      .first_block = room.blocks,
                                      .first_coarse = room.coarse,
                                      .least = range.first * header_.inverse_depth_unit,
                                      .most = range.second * header_.inverse_depth_unit};
        room.texels += image.width * image.height;
        room.blocks += blocks_of(image, shared::kWarpBlock);
        room.coarse += blocks_of(image, shared::kWarpCoarseBlock);
        images_.push_back(image);
    }
    return room;
}

void WarpImages::reserve(const Room& room) {
    records_ = gpu::Buffer(device_, images_.size() * sizeof(shared::WarpImage));
    if (room.texels == reserved_.texels && room.blocks == reserved_.blocks) {
        return;
    }
    reserved_ = room;
    texels_ = gpu::Buffer(device_, std::uint64_t{room.texels} * 8);
    blocks_ = gpu::Buffer(device_, std::uint64_t{room.blocks} * 8);
    coarse_ = gpu::Buffer(device_, std::uint64_t{room.coarse} * 8);
    texels_view_ = gpu::TexelView(device_, texels_, VK_FORMAT_R32G32_UINT);
    blocks_view_ = gpu::TexelView(device_, blocks_, VK_FORMAT_R32G32_SFLOAT);
    coarse_view_ = gpu::TexelView(device_, coarse_, VK_FORMAT_R32G32_SFLOAT);
    set_ = gpu::BindingSet(device_, layout_);
    set_.set(shared::kWarpTexels, texels_view_);
    set_.set(shared::kWarpBlocks, blocks_view_);
    set_.set(shared::kWarpCoarse, coarse_view_);
}

void WarpImages::record_unpack(const Plane& colour, const Plane& inverse_depth, std::uint32_t tile_count) {
    colour_ = gpu::Buffer(device_, (colour.bytes.size() + 3) / 4 * 4); // kernels read whole words
    inverse_depth_ = gpu::Buffer(device_, (inverse_depth.bytes.size() + 3) / 4 * 4);
    gpu::write_buffer(device_, colour_, colour.bytes);
    gpu::write_buffer(device_, inverse_depth_, inverse_depth.bytes);
    shared::WarpUnpackParams params{};
    params.images = records_.address();
    params.colour = colour_.address();
    params.inverse_depth = inverse_depth_.address();
    params.tiles = tile_count > 0 ? tiles_.address() : 0;
    params.texels = texels_.address();
    params.width = colour.width_px;
    params.height = colour.height_px;
    params.tile_count = tile_count;
    params.unit = header_.inverse_depth_unit;
    recorder_.dispatch(unpack_, {}, params, {gpu::groups_for(params.width, 8), gpu::groups_for(params.height, 8), 1});
    recorder_.barrier();
}

void WarpImages::record_links() {
    const shared::WarpLinkParams params{
        .images = records_.address(), .texels = texels_.address(), .unit = header_.inverse_depth_unit};
    recorder_.dispatch(link_, {}, params, // the source is the largest image
                       {gpu::groups_for(images_[0].width, 8), gpu::groups_for(images_[0].height, 8), image_count()});
    recorder_.barrier();
}

void WarpImages::record_bounds() {
    shared::WarpBoundsParams params{};
    params.images = records_.address();
    params.texels = texels_.address();
    params.blocks = blocks_.address();
    params.coarse = coarse_.address();
    for (const std::uint32_t side : {shared::kWarpBlock, shared::kWarpCoarseBlock}) {
        params.is_coarse = side == shared::kWarpCoarseBlock ? 1 : 0;
        const std::uint32_t group = 8 * side;
        recorder_.dispatch(
            bounds_, {}, params,
            {gpu::groups_for(images_[0].width, group), gpu::groups_for(images_[0].height, group), image_count()});
        recorder_.barrier();
    }
}

// All cameras have the same orientation. With o the target's position in the image camera's plane, the point X of the
// target's space is X + o in the image camera's space.
shared::WarpPath WarpImages::path(std::size_t index, const Camera& target) const {
    const Camera& image = cameras_[index];
    const glm::vec3 moved(target.world_from_camera[3] - image.world_from_camera[3]);
    const float right = glm::dot(moved, glm::vec3(image.world_from_camera[0]));
    const float up = glm::dot(moved, glm::vec3(image.world_from_camera[1]));
    const float scale = image.focal_px / target.focal_px;
    return {.offset = image.principal_px - scale * target.principal_px,
            .parallax = image.focal_px * glm::vec2(right, -up),
            .scale = scale};
}

} // namespace fieldcast::render
