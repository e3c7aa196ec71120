// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/picture_id.h"
#include "bench/quality/reference_picture.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace fieldcast::bench {

/// Masks of one picture; an empty mask selects no pixel.
struct PictureMasks {
    std::vector<bool> holes;  ///< pixels that the source did not show
    std::vector<bool> moving; ///< pixels at or near moving objects
};

/// Errors of one picture.
struct PictureScore {
    PictureId id;
    double rmse = 0.0;
    double ssim = 0.0;
    double rmse_without_noise = 0.0; ///< estimated RMSE against a reference without noise
    double ssim_without_noise = 0.0;
    double relative_mse = 0.0;
};

/// Mean, extremes and spread of some values.
struct Spread {
    double mean = 0.0;
    double min = 0.0;
    double max = 0.0;
    double deviation = 0.0; ///< standard deviation, n in the denominator
};

/// `values` are not empty.
Spread spread_of(const std::vector<double>& values);

/// Errors of pictures against references; display-referred (core/image/metrics.h), except relMSE, which is linear.
/// RMSE, SSIM and relMSE are means over pictures, as in the paper; errors of parts are over all pixels of the part.
class Scores {
public:
    void add(const PictureId& id, const image::RgbF32& linear, const ReferencePicture& reference, float exposure,
             const PictureMasks& masks);

    /// rmse, ssim, rmse_without_noise, ssim_without_noise, relative_mse, rmse_holes, rmse_reused, rmse_border,
    /// rmse_moving. null: no picture, or no such pixels.
    nlohmann::ordered_json to_json() const;
    const std::vector<PictureScore>& pictures() const { return pictures_; }

private:
    struct Part {
        double squared = 0.0;
        double pixels = 0.0;
        nlohmann::ordered_json rmse() const;
    };

    std::vector<PictureScore> pictures_;
    Part holes_;
    Part reused_;
    Part border_; ///< 32 pixels wide
    Part moving_;
};

} // namespace fieldcast::bench
