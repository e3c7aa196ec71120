// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/quality/ground_truth.h"
#include "bench/quality/light_field_scores.h"
#include "bench/quality/scores.h"
#include "bench/quality/temporal_scores.h"

namespace fieldcast::bench {

/// One row of a quality table: a way to make views, and the scores of these views.
class QualityRow {
public:
    QualityRow(std::string name, std::unique_ptr<ViewMaker> maker);

    const std::string& name() const { return name_; }
    ViewMaker& maker() { return *maker_; }
    const ViewMaker& maker() const { return *maker_; }

    /// Adds the cost of the last frame to the means.
    void add_cost();

    /// Scores a view of the last frame and returns the view, linear.
    image::RgbF32 score(const PictureId& id, const ViewTruth& truth);

    /// Stores views of the last frame for comparison with those of the next.
    void keep_frame(const std::vector<LatticePosition>& positions);

    /// Adds views of the last frame to the measurement of flicker; the scene must have been at rest for long.
    void score_at_rest(const std::vector<LatticePosition>& positions);

    /// `truth`: references and surfaces of all views of `grid`; its views are filled in.
    void score_light_field(const ViewGrid& grid, LightFieldPictures& truth);

    /// Errors, frame_ms, traced_share, discard_share, hole_paths per frame; temporal and light_field if they were
    /// measured. null: not known.
    nlohmann::ordered_json to_json() const;
    const Scores& scores() const { return scores_; }

private:
    std::string name_;
    std::unique_ptr<ViewMaker> maker_;
    Scores scores_;
    TemporalScores temporal_;
    std::map<LatticePosition, image::RgbF32> before_; ///< display-referred
    nlohmann::ordered_json light_field_;
    std::vector<double> frame_ms_;
    FrameCost sum_;
};

} // namespace fieldcast::bench
