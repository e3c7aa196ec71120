// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/render_settings.h"

#include <sstream>

namespace fieldcast {

std::optional<HoleFilling> parse_hole_filling(const std::string& text, std::uint32_t rows, std::uint32_t cols) {
    if (text == "all") {
        return parse_hole_filling("previous,isolated,cascade,source,denoise", rows, cols);
    }
    HoleFilling holes = HoleFilling::path_traced();
    if (text.ends_with(",")) {
        return std::nullopt; // getline does not return an empty last word
    }
    if (text == "none") {
        return holes;
    }
    std::istringstream words(text);
    std::size_t count = 0;
    for (std::string word; std::getline(words, word, ','); ++count) {
        if (word == "previous") {
            holes.previous_frame = true;
        } else if (word == "isolated") {
            holes.isolated = true;
        } else if (word == "cascade") {
            holes.cascade_rows = rows;
            holes.cascade_cols = cols;
        } else if (word == "source") {
            holes.end_in_source = true;
        } else if (word == "denoise") {
            holes.denoise = true;
        } else {
            return std::nullopt;
        }
    }
    return count > 0 ? std::optional(holes) : std::nullopt;
}

} // namespace fieldcast
