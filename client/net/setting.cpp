// SPDX-License-Identifier: Apache-2.0
#include "client/net/setting.h"

#include "core/lightfield/frame_rate.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace fieldcast::client::net {

SettingProblem read_number(const std::string& text, double low, double high, double& result) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || !(number >= low && number <= high)) {
        char range[64];
        std::snprintf(range, sizeof range, "a number from %g to %g", low, high);
        return std::string("write ") + range;
    }
    result = number;
    return {};
}

SettingProblem read_count(const std::string& text, std::uint32_t low, std::uint32_t high, std::uint32_t& result) {
    double number = 0.0;
    SettingProblem problem = read_number(text, low, high, number);
    if (problem.empty() && number != std::floor(number)) {
        problem = "write a whole number";
    }
    if (problem.empty()) {
        result = static_cast<std::uint32_t>(number);
    }
    return problem;
}

SettingProblem read_float(const std::string& text, double low, double high, float& result) {
    double number = 0.0;
    SettingProblem problem = read_number(text, low, high, number);
    result = static_cast<float>(number);
    return problem;
}

SettingProblem read_rate(const std::string& text, float& result) {
    constexpr double kMaxFps = 1000.0;
    float number = 0.0F;
    if (!read_float(text, 0.0, kMaxFps, number).empty() || !is_rate_bound(number)) {
        return "write 0, or a number from 0.1 to 1000";
    }
    result = number;
    return {};
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

} // namespace fieldcast::client::net
