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

/// Temporal stability of pictures.
class TemporalScores {
public:
    /// `map`: previous positions of the current pixels. `reference`: the same two frames path traced with many samples,
    /// or null if one of them is missing.
    void add(const SuccessivePictures& pictures, const SuccessivePictures* reference, const image::Correspondence& map);

    /// Adds one frame of a view while camera and scene are at rest.
    void add_at_rest(LatticePosition position, const image::RgbF32& display);

    /// warped_error: mean of |now − before, moved to the current position| over pixels that both frames show;
    /// warped_error_excess: that minus the references' own, null unless all of them are there; flicker: standard
    /// deviation over frames at rest, null if there were none.
    nlohmann::ordered_json to_json() const;

private:
    std::vector<double> warped_;
    std::vector<double> warped_references_;
    std::map<LatticePosition, image::Flicker> flicker_;
};

} // namespace fieldcast::bench
