// SPDX-License-Identifier: Apache-2.0
#include "core/base/utf8.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace fieldcast {

namespace {

struct CodeRange {
    char32_t first;
    char32_t last;
};

/// Unicode 15.1: general categories Cc, Zl and Zp, and characters of Cf with the property Bidi_Control or
/// Default_Ignorable_Code_Point.
constexpr std::array kCommands = std::to_array<CodeRange>({
    {0x0000, 0x001F},   // C0
    {0x007F, 0x009F},   // DELETE, C1
    {0x00AD, 0x00AD},   // soft hyphen
    {0x061C, 0x061C},   // Arabic letter mark
    {0x180B, 0x180F},   // Mongolian selectors and vowel separator
    {0x200B, 0x200F},   // zero width, left-to-right and right-to-left mark
    {0x2028, 0x202E},   // line and paragraph separator, embeddings and overrides
    {0x2060, 0x206F},   // word joiner, invisible operators, isolates, deprecated controls
    {0xFE00, 0xFE0F},   // variation selectors
    {0xFEFF, 0xFEFF},   // byte order mark
    {0xFFF9, 0xFFFB},   // interlinear annotations
    {0xE0000, 0xE0FFF}, // tags, further selectors
});

} // namespace

std::size_t character_size(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0U; };
    const auto is_tail = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
    const unsigned first = byte(0);
    if (first < 0x80) {
        return 1;
    }
    if (first >= 0xC2 && first <= 0xDF) {
        return is_tail(1) ? 2 : 0;
    }
    if (first >= 0xE0 && first <= 0xEF) {
        const bool is_overlong = first == 0xE0 && byte(1) < 0xA0;
        const bool is_surrogate = first == 0xED && byte(1) > 0x9F;
        return is_tail(1) && is_tail(2) && !is_overlong && !is_surrogate ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
        const bool is_overlong = first == 0xF0 && byte(1) < 0x90;
        const bool is_too_large = first == 0xF4 && byte(1) > 0x8F;
        return is_tail(1) && is_tail(2) && is_tail(3) && !is_overlong && !is_too_large ? 4 : 0;
    }
    return 0;
}

char32_t code_point(std::string_view character) {
    const auto first = static_cast<std::uint8_t>(character.front());
    const unsigned lead_bits = character.size() == 1 ? 0x7FU : 0x7FU >> character.size();
    char32_t code = first & lead_bits;
    for (const char tail : character.substr(1)) {
        code = (code << 6U) | (static_cast<std::uint8_t>(tail) & 0x3FU);
    }
    return code;
}

bool is_invisible_command(char32_t code) {
    return std::ranges::any_of(kCommands, [=](CodeRange range) { return code >= range.first && code <= range.last; });
}

} // namespace fieldcast
