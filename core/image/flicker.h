// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"

namespace fieldcast::image {

/// Measures how much the pixels of a picture change from frame to frame while nothing moves.
class Flicker {
public:
    /// Adds one frame, display-referred; all have one size.
    void add(const RgbF32& picture);

    /// Mean over pixels and channels of the standard deviation over frames (n − 1 in the denominator). At least two
    /// frames were added.
    double deviation() const;

private:
    double count_ = 0.0;
    std::vector<glm::dvec3> mean_;
    std::vector<glm::dvec3> squares_; ///< summed squared distances from the mean
};

} // namespace fieldcast::image
