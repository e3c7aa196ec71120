// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace fieldcast {

/// Stands for bytes that are no character: U+FFFD.
inline constexpr std::string_view kReplacementCharacter = "\xEF\xBF\xBD";

/// Bytes of the UTF-8 character that `text` begins with; 0 if it begins with none (RFC 3629, section 4).
std::size_t character_size(std::string_view text);

/// The code point of one character, which must be valid UTF-8.
char32_t code_point(std::string_view character);

/// Characters that terminals and editors obey instead of showing them: C0 and C1 controls, separators of lines, what
/// turns the direction of writing, and what cannot be seen at all.
bool is_invisible_command(char32_t code);

} // namespace fieldcast
