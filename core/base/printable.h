// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fieldcast {

inline constexpr std::size_t kMaxPrintableBytes = 1024;

/// Makes text from a peer or a file safe for terminals and logs. The result has at most `max_bytes` of the text. It has
/// a blank in place of each character that a terminal would interpret instead of showing it (see is_invisible_command),
/// and U+FFFD in place of bytes that are not UTF-8.
std::string printable(std::string_view text, std::size_t max_bytes = kMaxPrintableBytes);

} // namespace fieldcast
