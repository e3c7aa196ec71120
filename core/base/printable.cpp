// SPDX-License-Identifier: Apache-2.0
#include "core/base/printable.h"

#include "core/base/utf8.h"

namespace fieldcast {

std::string printable(std::string_view text, std::size_t max_bytes) {
    std::string result;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::size_t size = character_size(rest);
        const std::string_view character = rest.substr(0, size);
        const std::string_view shown = size == 0                                     ? kReplacementCharacter
                                       : is_invisible_command(code_point(character)) ? std::string_view(" ")
                                                                                     : character;
        if (result.size() + shown.size() > max_bytes) {
            break;
        }
        result += shown;
        rest.remove_prefix(size == 0 ? 1 : size);
    }
    return result;
}

} // namespace fieldcast
