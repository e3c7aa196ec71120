// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/picture_id.h"
#include "core/image/correspondence.h"
#include "core/image/flicker.h"

#include <map>
#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// One view in two successive frames, display-referred.
struct SuccessivePictures {
    image::RgbF32 before;
    image::RgbF32 now;
};

/// How steady pictures are over time.
class TemporalScores {
public:
    /// `map`: where the pixels of now were before. `reference`: the same two frames path traced with many samples, or
    /// null if they are not both there.
    void add(const SuccessivePictures& pictures, const SuccessivePictures* reference, const image::Correspondence& map);

    /// One frame of a view while camera and scene are at rest.
    void add_at_rest(LatticePosition position, const image::RgbF32& display);

    /// warped_error: mean over pixels that the frame before shows too of |now − before, moved to where it is now|;
    /// warped_error_excess: that minus the references' own, null unless all of them are there; flicker: standard
    /// deviation over frames at rest, null if there were none.
    nlohmann::ordered_json to_json() const;

private:
    std::vector<double> warped_;
    std::vector<double> warped_references_;
    std::map<LatticePosition, image::Flicker> flicker_;
};

} // namespace fieldcast::bench
