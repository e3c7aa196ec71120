// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/quality/protocol.h"
#include "bench/quality/references.h"
#include "bench/quality/view_maker.h"

#include <map>

namespace fieldcast::bench {

/// What is known of one view in a scored frame, whatever the row that is scored.
struct ViewTruth {
    ReferencePicture reference;
    std::vector<bool> moving{};                      ///< around moving objects; empty: not known
    std::optional<image::Correspondence> before{};   ///< where its pixels were in the frame before, if that was noted
    std::optional<image::RgbF32> reference_before{}; ///< linear, of the frame before, if there is one
};

/// Knows references, surfaces and motion of the views that are scored.
class GroundTruth {
public:
    GroundTruth(LightFieldScene& scene, References& references, const Protocol& protocol);

    /// Notes what the views show in this frame, in which the scene is posed, so that the next one can be compared with
    /// it. `maker` has rendered the frame and reuses.
    void note_frame(const ViewMaker& maker);

    /// Of frame `frame`, in which the scene is posed. `maker` has rendered it and reuses; null: only references are
    /// known.
    std::map<LatticePosition, ViewTruth> of_frame(std::uint32_t frame, const ViewMaker* maker);

private:
    void add_motion(ViewTruth& truth, std::uint32_t frame, LatticePosition position, const ViewMaker& maker);

    LightFieldScene& scene_;
    References& references_;
    const Protocol& protocol_;
    std::map<LatticePosition, image::ViewSurfaces> noted_;
    std::int64_t noted_time_ns_ = -1;
};

} // namespace fieldcast::bench
