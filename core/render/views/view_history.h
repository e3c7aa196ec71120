// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/views/hole_filler.h"
#include "core/render/views/view_filter.h"

#include <memory>
#include <span>

namespace fieldcast::render {

/// Holes of one set of views over frames.
struct HistoryOfHoles {
    ViewRequest request; ///< with the corner views
    std::uint64_t pose_count = 0;
    std::uint64_t last_use = 0;
    HoleHistory holes;
};

/// What is kept of views from frame to frame. A channel has few sets of views; those not used for longest are
/// forgotten.
class ViewHistories {
public:
    ViewHistories(const gpu::Device& device, const scene::GpuScene& scene) : device_(device), scene_(scene) {}

    /// Of exactly these views.
    HistoryOfHoles& holes(const ViewRequest& request);

    /// Of views of this geometry, field of view and size: where their number changes, kernels and room are kept.
    ViewFilter& filter(const ViewRequest& request);

    /// Room that the filter of these views, if the settings ask for one, has not got.
    std::uint64_t missing_pixels(const ViewRequest& request) const;

    /// Forgets views of other kinds than those of `requests`.
    void forget_all_but(std::span<const ViewRequest> requests);

private:
    struct Filter {
        Filter(const gpu::Device& device, const scene::GpuScene& scene, ViewRequest shown)
            : kind(std::move(shown)), filter(device, scene) {}
        ViewRequest kind; ///< without positions
        std::uint64_t last_use = 0;
        ViewFilter filter;
    };

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    std::uint64_t use_count_ = 0;
    std::vector<std::unique_ptr<HistoryOfHoles>> holes_;
    std::vector<std::unique_ptr<Filter>> filters_;
};

} // namespace fieldcast::render
