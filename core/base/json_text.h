// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace fieldcast {

/// `text` as a JSON string, with quotes. Control characters are escaped; bytes that are not UTF-8 become U+FFFD, so
/// that the result is always valid (RFC 8259, section 7 and 8.1).
std::string json_text(std::string_view text);

} // namespace fieldcast
