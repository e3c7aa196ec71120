// SPDX-License-Identifier: Apache-2.0
#include "bench/measure.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"

#include <algorithm>
#include <span>
#include <sstream>
#include <sys/resource.h>
#include <system_error>

namespace fieldcast::bench {

std::string to_string(const Size& size) {
    return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

Size parse_size(const std::string& flag, const std::string& text) {
    Size size;
    char cross = 0;
    std::istringstream in(text);
    if (!(in >> size.width_px >> cross >> size.height_px) || cross != 'x' || !in.eof() || size.width_px == 0 ||
        size.height_px == 0 || size.width_px > 16384 || size.height_px > 16384) {
        throw UserError(flag + " " + text + ": expected WIDTHxHEIGHT, each 1 … 16384");
    }
    return size;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void write_json(const std::string& file, const nlohmann::ordered_json& json) {
    const std::string text = json.dump(2) + '\n';
    try {
        image::write_file_atomically(file, std::as_bytes(std::span(text)));
    } catch (const std::system_error& error) {
        throw UserError(file + ": cannot be written: " + error.code().message());
    }
}

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace fieldcast::bench
