// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fieldcast {

inline constexpr std::size_t kMaxPrintableBytes = 1024;

/// Text from a peer or a file, for people's terminals and logs: at most `max_bytes` of it, a blank in place of each
/// character that a terminal would obey instead of showing it (see is_invisible_command), and U+FFFD in place of bytes that
/// are no UTF-8.
std::string printable(std::string_view text, std::size_t max_bytes = kMaxPrintableBytes);

} // namespace fieldcast
