// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/views/hole_filler.h"
#include "core/render/views/view_filter.h"

#include <memory>
#include <span>

namespace fieldcast::render {

/// Hole history of one set of views.
struct HistoryOfHoles {
    ViewRequest request; ///< includes the corner views
    std::uint64_t pose_count = 0;
    std::uint64_t last_use = 0;
    HoleHistory holes;
};

/// Histories and filters of sets of views, kept from frame to frame. A channel uses few sets, so only the most recently
/// used ones are kept.
class ViewHistories {
public:
    ViewHistories(const gpu::Device& device, const scene::GpuScene& scene) : device_(device), scene_(scene) {}

    /// The hole history of exactly these views; created if missing.
    HistoryOfHoles& holes(const ViewRequest& request);

    /// The filter for views of this geometry, field of view and size; created if missing. A change of their number
    /// keeps its kernels and memory.
    ViewFilter& filter(const ViewRequest& request);

    /// Pixels that the filter of these views, if the settings require one, still has to allocate.
    std::uint64_t missing_pixels(const ViewRequest& request) const;

    /// Forgets all views whose geometry, field of view or size is not among `requests`.
    void forget_all_but(std::span<const ViewRequest> requests);

private:
    struct Filter {
        Filter(const gpu::Device& device, const scene::GpuScene& scene, ViewRequest shown)
            : kind(std::move(shown)), filter(device, scene) {}
        ViewRequest kind; ///< request without positions
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
