// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/quality/ground_truth.h"
#include "bench/quality/light_field_scores.h"
#include "bench/quality/scores.h"
#include "bench/quality/temporal_scores.h"

namespace fieldcast::bench {

/// One row of a quality table: a way to make views, and how good they were.
class QualityRow {
public:
    QualityRow(std::string name, std::unique_ptr<ViewMaker> maker);

    const std::string& name() const { return name_; }
    ViewMaker& maker() { return *maker_; }
    const ViewMaker& maker() const { return *maker_; }

    /// The last frame was one whose cost counts.
    void add_cost();

    /// Scores a view of the last frame; returns it, linear.
    image::RgbF32 score(const PictureId& id, const ViewTruth& truth);

    /// Keeps views of the last frame, to be compared with those of the next.
    void keep_frame(const std::vector<LatticePosition>& positions);

    /// The scene rests, and has for long: how much do views of the last frame differ from those of others at rest?
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
