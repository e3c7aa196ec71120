// SPDX-License-Identifier: Apache-2.0
// Memory that a GridRenderer keeps after a frame, and queries about the last frame.
#include "core/render/views/grid_renderer.h"
#include "core/render/views/grid_renderer_state.h"
#include "core/render/visibility_depth.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

namespace fieldcast::render {

namespace {

/// Visibility, light, layers and their list, image, reflections; the map of holes, two lists of its pixels with room to
/// grow, and the arrays of holes if a tenth of all pixels are holes.
constexpr std::uint64_t kBytesToRender = 8 + 8 + 16 + 4 + 3 + 4 + 1 + 2 * 5 + 10;

} // namespace

/// (instance, primitive) of each pixel.
std::vector<glm::uvec2> GridRendererState::download_visibility(std::size_t view) const {
    FC_ASSERT(view < wanted, "no such view");
    const std::size_t count = static_cast<std::size_t>(request.width_px) * request.height_px;
    return gpu::read_buffer_as<glm::uvec2>(device, visibility, count, 8ULL * view_stride(request) * view);
}

std::uint64_t GridRenderer::bytes_per_pixel(const RenderSettings& settings) {
    const bool has_filter = settings.denoised_images == DenoisedImages::kViews || settings.accumulate_views;
    return kBytesToRender + (has_filter ? ViewFilter::bytes_per_pixel(settings) : 0);
}

std::uint64_t GridRenderer::missing_bytes(const RenderSettings& settings, const ViewRequest& request) const {
    const std::uint64_t pixels = std::uint64_t{view_stride(request)} * request.positions.size();
    const std::uint64_t rendered = pixels - std::min(pixels, state_->view_pixels);
    const std::uint64_t filter_bytes = bytes_per_pixel(settings) - kBytesToRender;
    const std::uint64_t filtered = filter_bytes > 0 ? state_->histories.missing_pixels(request) : 0;
    return rendered * kBytesToRender + filtered * filter_bytes;
}

void GridRenderer::forget_all_but(std::span<const ViewRequest> requests) {
    GridRendererState& s = *state_;
    s.histories.forget_all_but(requests);
    s.filter = nullptr;
    s.filler.forget();
    s.reflections.forget();
    s.readback.forget();
    s.view_pixels = 0; // the next frame allocates what it needs
    s.visibility = {};
    s.layers = {};
    s.radiance = {};
    s.layer_pixels = {};
    s.rgb8 = {};
}

LinearView GridRenderer::linear_view(std::size_t index) const {
    const GridRendererState& s = *state_;
    FC_ASSERT(index < s.wanted, "no such view");
    const std::size_t count = static_cast<std::size_t>(s.request.width_px) * s.request.height_px;
    const auto texels = gpu::read_buffer_as<glm::uvec2>(s.device, s.radiance, count,
                                                        8ULL * view_stride(s.request) * index);
    LinearView view{s.request.width_px, s.request.height_px, {}};
    view.pixels.reserve(count);
    for (const glm::uvec2 texel : texels) {
        const glm::vec2 rg = glm::unpackHalf2x16(texel.x);
        view.pixels.emplace_back(rg.x, rg.y, glm::unpackHalf2x16(texel.y).x);
    }
    return view;
}

std::vector<float> GridRenderer::view_depth(std::size_t index) const {
    return depth_of_visibility(state_->scene, state_->view_cameras.at(index), state_->download_visibility(index));
}

std::vector<std::uint32_t> GridRenderer::view_instances(std::size_t index) const {
    std::vector<std::uint32_t> instances;
    for (const glm::uvec2 seen : state_->download_visibility(index)) {
        instances.push_back(seen.x); // shared::kNoInstance is scene::kNone
    }
    return instances;
}

std::vector<bool> GridRenderer::hole_mask(std::size_t index) const {
    const GridRendererState& s = *state_;
    FC_ASSERT(index < s.wanted, "no such view");
    return s.filler.mask(static_cast<std::uint32_t>(index));
}

HoleCounts GridRenderer::hole_counts() const {
    return state_->hole_counts;
}

std::uint64_t GridRenderer::invalid_sample_count() const {
    return state_->invalid_samples;
}

} // namespace fieldcast::render
