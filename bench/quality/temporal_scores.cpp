// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/temporal_scores.h"

#include "bench/quality/scores.h"

namespace fieldcast::bench {

void TemporalScores::add(const SuccessivePictures& pictures, const SuccessivePictures* reference,
                         const image::Correspondence& map) {
    const auto warped = image::warped_difference(pictures.now, pictures.before, map);
    if (!warped) {
        return; // no pixel of the previous frame is still visible
    }
    warped_.push_back(*warped);
    if (reference != nullptr) {
        warped_references_.push_back(image::warped_difference(reference->now, reference->before, map).value());
    }
}

void TemporalScores::add_at_rest(LatticePosition position, const image::RgbF32& display) {
    flicker_[position].add(display);
}

nlohmann::ordered_json TemporalScores::to_json() const {
    nlohmann::ordered_json json{{"warped_error", nullptr}, {"warped_error_excess", nullptr}, {"flicker", nullptr}};
    if (!warped_.empty()) {
        json["warped_error"] = spread_of(warped_).mean;
    }
    if (!warped_.empty() && warped_.size() == warped_references_.size()) {
        json["warped_error_excess"] = spread_of(warped_).mean - spread_of(warped_references_).mean;
    }
    std::vector<double> deviations;
    for (const auto& [position, flicker] : flicker_) {
        deviations.push_back(flicker.deviation());
    }
    if (!deviations.empty()) {
        json["flicker"] = spread_of(deviations).mean;
    }
    return json;
}

} // namespace fieldcast::bench
