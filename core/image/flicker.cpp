// SPDX-License-Identifier: Apache-2.0
// Running variance: B. P. Welford. Note on a Method for Calculating Corrected Sums of Squares and Products.
// Technometrics 4(3), 1962.
#include "core/image/flicker.h"

#include "core/base/error.h"

namespace fieldcast::image {

void Flicker::add(const RgbF32& picture) {
    if (mean_.empty()) {
        mean_.resize(picture.pixels.size(), glm::dvec3(0.0));
        squares_ = mean_;
    }
    FC_ASSERT(picture.pixels.size() == mean_.size(), "frames have one size");
    count_ += 1.0;
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        const glm::dvec3 before = glm::dvec3(picture.pixels[i]) - mean_[i];
        mean_[i] += before / count_;
        squares_[i] += before * (glm::dvec3(picture.pixels[i]) - mean_[i]);
    }
}

double Flicker::deviation() const {
    FC_ASSERT(count_ >= 2.0 && !mean_.empty(), "a deviation needs two frames");
    double sum = 0.0;
    for (const glm::dvec3& squares : squares_) {
        const glm::dvec3 deviation = glm::sqrt(squares / (count_ - 1.0));
        sum += deviation.x + deviation.y + deviation.z;
    }
    return sum / (3.0 * static_cast<double>(squares_.size()));
}

} // namespace fieldcast::image
