// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/view_maker.h"

#include "bench/picture_id.h"
#include "core/base/error.h"
#include "core/lightfield/sources.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

std::vector<LatticePosition> source_positions(const Preset& preset, const ViewGrid& grid) {
    auto positions = parse_sources(preset.sources, grid);
    if (!positions) {
        throw UserError("sources " + preset.sources +
                        ": middle, top-left, diagonal, triangle, corners, or views of the grid as in \"0,0;5,5\"");
    }
    return std::move(*positions);
}

} // namespace

ViewMaker::ViewMaker(const gpu::Device& device, LightFieldScene& scene, float exposure)
    : scene_(scene), one_sample_(std::make_unique<render::ReferenceRenderer>(device, scene.gpu_scene())),
      exposure_(exposure) {}

ViewMaker::ViewMaker(const gpu::Device& device, LightFieldScene& scene, const Preset& preset)
    : scene_(scene), run_(std::make_unique<LightFieldRun>(device, scene, preset.settings, preset.has_guard_band,
                                                          source_positions(preset, scene.grid()))),
      exposure_(run_->header().settings.exposure) {}

void ViewMaker::render(std::uint32_t frame, const std::vector<LatticePosition>& positions) {
    frame_ = frame;
    positions_ = positions;
    if (!run_) {
        return; // pictures are made on request
    }
    const Views views = run_->render(frame, positions);
    cost_ = {};
    for (const StageTime& time : views.header.render_times) {
        cost_.frame_ms += time.ms;
    }
    discards_.clear();
    for (const View& view : views.views) {
        discards_.push_back(view.discards.total());
        cost_.discarded += discards_.back();
    }
    cost_.traced = static_cast<double>(run_->grid_renderer().hole_counts().traced);
    const auto& sources = run_->header().source_positions;
    const auto synthesised = std::ranges::count_if(positions, [&](LatticePosition position) {
        return std::ranges::find(sources, position) == sources.end();
    });
    cost_.synthesised = static_cast<double>(synthesised) * scene_.size().width_px * scene_.size().height_px;
}

std::size_t ViewMaker::index_of(LatticePosition position) const {
    const auto found = std::ranges::find(positions_, position);
    FC_ASSERT(found != positions_.end(), "the view was rendered");
    return static_cast<std::size_t>(found - positions_.begin());
}

image::RgbF32 ViewMaker::picture(LatticePosition position) {
    const Size& size = scene_.size();
    if (run_) {
        return {size.width_px, size.height_px, run_->grid_renderer().linear_view(index_of(position)).pixels};
    }
    one_sample_->start(scene_.view(position));
    RenderSettings settings;
    settings.exposure = exposure_;
    settings.light_sampling = LightSampling::plain(); // the paper's input
    // A different seed for each view: equal noise would not average out in refocused images.
    const ViewIndex index = view_index(position);
    one_sample_->accumulate(settings, frame_ + 4096U * static_cast<std::uint32_t>(6 * index.row + index.col + 1));
    return {size.width_px, size.height_px, one_sample_->image()};
}

std::vector<bool> ViewMaker::hole_mask(LatticePosition position) const {
    return run_ ? run_->grid_renderer().hole_mask(index_of(position)) : std::vector<bool>();
}

image::ViewSurfaces ViewMaker::surfaces(LatticePosition position) const {
    FC_ASSERT(run_, "surfaces are known where views are reused");
    const std::size_t index = index_of(position);
    const render::GridRenderer& renderer = run_->grid_renderer();
    return {scene_.view(position), renderer.view_depth(index), renderer.view_instances(index)};
}

std::uint32_t ViewMaker::discards(LatticePosition position) const {
    return run_ ? discards_[index_of(position)] : 0;
}

std::uint64_t ViewMaker::invalid_samples() const {
    return run_ ? run_->invalid_samples() : one_sample_->invalid_sample_count();
}

} // namespace fieldcast::bench
