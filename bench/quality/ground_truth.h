// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/quality/protocol.h"
#include "bench/quality/references.h"
#include "bench/quality/view_maker.h"

#include <map>

namespace fieldcast::bench {

/// Known facts of one view in a scored frame, the same for all rows.
struct ViewTruth {
    ReferencePicture reference;
    std::vector<bool> moving{};                      ///< pixels at or near moving objects; empty: unknown
    std::optional<image::Correspondence> before{};   ///< position of its pixels in the previous frame, if noted
    std::optional<image::RgbF32> reference_before{}; ///< linear, of the previous frame, if there is one
};

/// Provides references, surfaces and motion of the scored views.
class GroundTruth {
public:
    GroundTruth(LightFieldScene& scene, References& references, const Protocol& protocol);

    /// Stores the surfaces that the views show in the current frame, for comparison with the next frame. The scene is
    /// posed in this frame, and `maker` has rendered it with reuse.
    void note_frame(const ViewMaker& maker);

    /// The facts of frame `frame`, in which the scene is posed. `maker` has rendered it with reuse; null: only
    /// references are known.
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
