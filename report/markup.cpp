// SPDX-License-Identifier: Apache-2.0
#include "report/markup.h"

#include <array>
#include <iomanip>
#include <sstream>

namespace fieldcast::report {

std::string joined(std::initializer_list<std::string_view> parts) {
    std::string result;
    for (const std::string_view part : parts) {
        result += part;
    }
    return result;
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&#39;";
            break;
        default:
            if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') {
                result += c;
            }
        }
    }
    return result;
}

Markup text(std::string_view text) {
    return {escaped(text)};
}

Markup element(std::string_view tag, std::string_view style, const Markup& content) {
    const std::string classes = style.empty() ? std::string() : joined({" class=\"", style, "\""});
    return {joined({"<", tag, classes, ">", content.html, "</", tag, ">\n"})};
}

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        unsigned word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8U | (k < count ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            result += k <= count ? kDigits[word >> (18U - 6U * k) & 63U] : '=';
        }
    }
    return result;
}

std::string fixed(double value, int digits) {
    std::ostringstream stream;
    stream << std::fixed << std::setprecision(digits) << value;
    return stream.str();
}

} // namespace fieldcast::report
