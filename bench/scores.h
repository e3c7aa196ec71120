// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"
#include "core/lightfield/views.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace fieldcast::bench {

/// Errors of pictures against references, display-referred (core/image/metrics.h) unless it says linear. RMSE, SSIM and
/// relMSE are means over pictures, as in the paper; those of parts of pictures are over all pixels of the part.
class Scores {
public:
    /// Scores one view. `hole_mask`: pixels the source did not show, may be empty.
    void add(const image::RgbF32& linear, const image::RgbF32& reference, float exposure,
             const std::vector<bool>& hole_mask);

    nlohmann::ordered_json to_json() const;

private:
    struct Part {
        double squared = 0.0;
        double pixels = 0.0;
        double rmse() const;
    };

    std::vector<double> rmse_;
    std::vector<double> ssim_;
    std::vector<double> relative_mse_;
    Part holes_;
    Part reused_;
    Part border_; ///< 32 pixels wide
};

} // namespace fieldcast::bench
