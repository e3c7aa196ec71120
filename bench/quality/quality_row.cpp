// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/quality_row.h"

#include "bench/measure.h"
#include "core/image/metrics.h"

#include <algorithm>

namespace fieldcast::bench {

QualityRow::QualityRow(std::string name, std::unique_ptr<ViewMaker> maker)
    : name_(std::move(name)), maker_(std::move(maker)) {}

void QualityRow::add_cost() {
    const FrameCost& cost = maker_->cost();
    frame_ms_.push_back(cost.frame_ms);
    sum_.discarded += cost.discarded;
    sum_.traced += cost.traced;
    sum_.synthesised += cost.synthesised;
}

image::RgbF32 QualityRow::score(const PictureId& id, const ViewTruth& truth) {
    const float exposure = maker_->exposure();
    image::RgbF32 picture = maker_->picture(id.position);
    scores_.add(id, picture, truth.reference, exposure, {maker_->hole_mask(id.position), truth.moving});
    const auto before = before_.find(id.position);
    if (truth.before && before != before_.end()) {
        const SuccessivePictures pictures{before->second, image::display_image(picture, exposure)};
        if (truth.reference_before) {
            const SuccessivePictures references{image::display_image(*truth.reference_before, exposure),
                                                image::display_image(truth.reference.mean, exposure)};
            temporal_.add(pictures, &references, *truth.before);
        } else {
            temporal_.add(pictures, nullptr, *truth.before);
        }
    }
    return picture;
}

void QualityRow::keep_frame(const std::vector<LatticePosition>& positions) {
    for (const LatticePosition position : positions) {
        before_[position] = image::display_image(maker_->picture(position), maker_->exposure());
    }
}

void QualityRow::score_at_rest(const std::vector<LatticePosition>& positions) {
    for (const LatticePosition position : positions) {
        temporal_.add_at_rest(position, image::display_image(maker_->picture(position), maker_->exposure()));
    }
}

void QualityRow::score_light_field(const ViewGrid& grid, LightFieldPictures& truth) {
    truth.views.clear();
    for (const LatticePosition position : lattice_positions(grid)) {
        truth.views.push_back(maker_->picture(position));
    }
    light_field_ = light_field_scores(grid, truth, maker_->exposure());
}

nlohmann::ordered_json QualityRow::to_json() const {
    nlohmann::ordered_json json = scores_.to_json();
    const bool has_cost = maker_->reuses() && !frame_ms_.empty();
    const double synthesised = std::max(1.0, sum_.synthesised);
    json["frame_ms"] = has_cost ? nlohmann::ordered_json(median(frame_ms_)) : nullptr;
    json["traced_share"] = has_cost ? nlohmann::ordered_json(sum_.traced / synthesised) : nlohmann::ordered_json(1.0);
    json["discard_share"] = has_cost ? nlohmann::ordered_json(sum_.discarded / synthesised) : nullptr;
    json["hole_paths"] =
        has_cost ? nlohmann::ordered_json(sum_.traced / static_cast<double>(frame_ms_.size())) : nullptr;
    const nlohmann::ordered_json temporal = temporal_.to_json();
    if (!temporal["warped_error"].is_null() || !temporal["flicker"].is_null()) {
        json["temporal"] = temporal;
    }
    if (!light_field_.is_null()) {
        json["light_field"] = light_field_;
    }
    return json;
}

} // namespace fieldcast::bench
