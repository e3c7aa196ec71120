// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

namespace fieldcast::client::net {

/// Text from outside, for people: bounded and without control characters, which terminals obey.
inline std::string printable(const std::string& text) {
    constexpr std::size_t kMaxTextBytes = 1024;
    std::string result = text.substr(0, kMaxTextBytes);
    std::replace_if(
        result.begin(), result.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
    return result;
}

} // namespace fieldcast::client::net
