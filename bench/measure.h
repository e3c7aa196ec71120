// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fieldcast::bench {

struct Size {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
};

std::string to_string(const Size& size); ///< "1280x720"

/// Reads "1280x720". Throws UserError naming `flag`.
Size parse_size(const std::string& flag, const std::string& text);

/// Median (the upper one of two middle values); `values` must not be empty.
double median(std::vector<double> values);

/// Writes indented JSON. The file appears complete or not at all. Throws UserError if it cannot be written.
void write_json(const std::string& file, const nlohmann::ordered_json& json);

/// Largest resident set of this process so far, in bytes.
std::uint64_t peak_rss_bytes();

} // namespace fieldcast::bench
