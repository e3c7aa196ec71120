// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_text.h"

#include "core/base/utf8.h"

namespace fieldcast {

namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

/// Appends one escape, or two for characters beyond U+FFFF (RFC 8259, section 7).
void append_escape(std::string& result, char32_t code) {
    if (code > 0xFFFF) {
        append_escape(result, 0xD800 + ((code - 0x10000) >> 10U));
        append_escape(result, 0xDC00 + ((code - 0x10000) & 0x3FFU));
        return;
    }
    result += "\\u";
    for (const unsigned shift : {12U, 8U, 4U, 0U}) {
        result += kDigits[(code >> shift) & 0xFU];
    }
}

} // namespace

std::string json_text(std::string_view text) {
    std::string result = "\"";
    while (!text.empty()) {
        const std::size_t size = character_size(text);
        const std::string_view character = text.substr(0, size);
        if (size == 0) {
            result += kReplacementCharacter;
        } else if (is_invisible_command(code_point(character))) {
            append_escape(result, code_point(character));
        } else {
            result += character == "\"" || character == "\\" ? "\\" : "";
            result += character;
        }
        text.remove_prefix(size == 0 ? 1 : size);
    }
    return result + '"';
}

} // namespace fieldcast
