// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace fieldcast::report {

/// A well-formed piece of HTML. Text becomes markup through text() only, so that none reaches a page unescaped.
struct Markup {
    std::string html;

    Markup& operator+=(const Markup& other) {
        html += other.html;
        return *this;
    }
};

/// The parts one after the other.
std::string joined(std::initializer_list<std::string_view> parts);

/// & < > " ' as character references; control characters that HTML does not know are left out.
std::string escaped(std::string_view text);
Markup text(std::string_view text);

/// <tag class="style">content</tag>; no class if `style` is empty. Neither is escaped.
Markup element(std::string_view tag, std::string_view style, const Markup& content);

/// RFC 4648, with padding.
std::string base64(std::span<const std::byte> bytes);

/// A number for people: fixed, `digits` decimals.
std::string fixed(double value, int digits);

} // namespace fieldcast::report
