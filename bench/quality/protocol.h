// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/measure.h"
#include "bench/picture_id.h"

#include <string>
#include <vector>

namespace fieldcast::bench {

/// The scored pictures: frames after a cold start at frame 0, and views of a 6×6 grid.
struct Protocol {
    std::string name;
    Size size;
    std::vector<std::uint32_t> frames;
    std::vector<LatticePosition> views;
    std::uint32_t reference_samples = 0;

    bool is_scored(std::uint32_t frame) const;
    std::vector<PictureId> pictures() const; ///< frame by frame
};

/// "reduced" (for two processor cores) or "full" (for a GPU). Throws UserError.
Protocol find_protocol(const std::string& name);

} // namespace fieldcast::bench
