// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/light_field_run.h"
#include "core/image/correspondence.h"
#include "core/image/image_file.h"
#include "core/lightfield/presets.h"
#include "core/render/reference_renderer.h"

namespace fieldcast::bench {

/// Time and traced pixels of one frame.
struct FrameCost {
    double frame_ms = 0.0;
    double discarded = 0.0;   ///< pixels that could not be reused
    double traced = 0.0;      ///< of these, pixels that were path traced
    double synthesised = 0.0; ///< pixels of all views that are not sources
};

/// Makes the views of successive frames in one way, which is one row of a quality table.
class ViewMaker {
public:
    /// Every view path traced with one sample per pixel, nothing reused.
    ViewMaker(const gpu::Device& device, LightFieldScene& scene, float exposure);
    /// Makes views with a preset, for the current grid of `scene`.
    ViewMaker(const gpu::Device& device, LightFieldScene& scene, const Preset& preset);

    /// Renders frame number `frame` with the current pose of the scene.
    void render(std::uint32_t frame, const std::vector<LatticePosition>& positions);

    bool reuses() const { return run_ != nullptr; } ///< false: only pictures are available

    /// Linear radiance of a view of the last frame; the scene must still have the pose of that frame.
    image::RgbF32 picture(LatticePosition position);
    std::vector<bool> hole_mask(LatticePosition position) const; ///< empty if nothing is reused
    image::ViewSurfaces surfaces(LatticePosition position) const;
    std::uint32_t discards(LatticePosition position) const;
    const FrameCost& cost() const { return cost_; } ///< of the last frame
    float exposure() const { return exposure_; }
    std::uint64_t invalid_samples() const;

private:
    std::size_t index_of(LatticePosition position) const;

    LightFieldScene& scene_;
    std::unique_ptr<LightFieldRun> run_;
    std::unique_ptr<render::ReferenceRenderer> one_sample_;
    float exposure_;
    std::uint32_t frame_ = 0;
    std::vector<LatticePosition> positions_;
    std::vector<std::uint32_t> discards_;
    FrameCost cost_;
};

} // namespace fieldcast::bench
