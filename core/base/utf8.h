// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace fieldcast {

/// Replaces bytes that are not a character: U+FFFD.
inline constexpr std::string_view kReplacementCharacter = "\xEF\xBF\xBD";

/// Size of the UTF-8 character at the beginning of `text`, bytes; 0 if there is none (RFC 3629, section 4).
std::size_t character_size(std::string_view text);

/// The code point of one character, which must be valid UTF-8.
char32_t code_point(std::string_view character);

/// Whether terminals and editors interpret the character instead of showing it: C0 and C1 controls, line separators,
/// direction controls, and invisible characters.
bool is_invisible_command(char32_t code);

} // namespace fieldcast
