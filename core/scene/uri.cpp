// SPDX-License-Identifier: Apache-2.0
#include "core/scene/uri.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

namespace fieldcast::scene {

namespace {

constexpr std::size_t kMaxPath = 1024;
constexpr std::size_t kMaxSegment = 255;

std::optional<unsigned> hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return static_cast<unsigned>(c - '0');
    }
    const char lower = static_cast<char>(c | 0x20);
    if (lower >= 'a' && lower <= 'f') {
        return static_cast<unsigned>(lower - 'a') + 10U;
    }
    return std::nullopt;
}

Decoded<std::string> decode_percent(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out.push_back(text[i]);
            continue;
        }
        const auto high = i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
        const auto low = i + 2 < text.size() ? hex_digit(text[i + 2]) : std::nullopt;
        if (!high || !low) {
            return decode_error("percent-encoding is broken: '%' needs two hexadecimal digits");
        }
        out.push_back(static_cast<char>(*high << 4U | *low));
        i += 2;
    }
    return out;
}

std::optional<std::uint32_t> base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') {
        return static_cast<std::uint32_t>(c - 'A');
    }
    if (c >= 'a' && c <= 'z') {
        return static_cast<std::uint32_t>(c - 'a') + 26U;
    }
    if (c >= '0' && c <= '9') {
        return static_cast<std::uint32_t>(c - '0') + 52U;
    }
    return c == '+' ? std::optional(62U) : c == '/' ? std::optional(63U) : std::nullopt;
}

Decoded<std::vector<std::byte>> decode_base64(std::string_view text) {
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) {
        text.remove_suffix(1);
    }
    if (text.size() % 4 == 1) {
        return decode_error("base64 text has an impossible length");
    }
    std::vector<std::byte> out;
    out.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    unsigned bit_count = 0;
    for (const char c : text) {
        const auto digit = base64_digit(c);
        if (!digit) {
            return decode_error("data is not base64");
        }
        bits = (bits << 6U | *digit) & 0xFFFFFFU;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            out.push_back(static_cast<std::byte>(bits >> bit_count & 0xFFU));
        }
    }
    return out;
}

bool has_scheme(std::string_view path) {
    const std::size_t colon = path.find(':');
    return colon != std::string_view::npos && colon < path.find('/');
}

} // namespace

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

Decoded<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos) {
        return decode_error("data URI is broken: it needs a comma before its data");
    }
    if (uri.substr(0, comma).ends_with(";base64")) {
        return decode_base64(uri.substr(comma + 1));
    }
    return decode_percent(uri.substr(comma + 1)).map([](const std::string& text) {
        const auto bytes = std::as_bytes(std::span(text));
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    });
}

Decoded<std::string> check_relative_path(std::string_view path) {
    if (path.empty() || path.size() > kMaxPath) {
        return decode_error(path.empty() ? "path is empty" : "path is too long: at most 1024 bytes");
    }
    if (path.front() == '/' || path.find('\\') != std::string_view::npos) {
        return decode_error("absolute path or backslash is not allowed; use a relative path with '/'");
    }
    if (has_scheme(path)) {
        return decode_error("URI with a scheme is not allowed; use a relative path");
    }
    if (std::any_of(path.begin(), path.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; })) {
        return decode_error("path contains a control character");
    }
    std::string out;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string_view segment = path.substr(begin, end - begin);
        begin = end + 1;
        if (segment == "..") {
            return decode_error("path leaves the scene's folder ('..')");
        }
        if (segment.size() > kMaxSegment) {
            return decode_error("path is too long: at most 255 bytes per file or folder name");
        }
        if (!segment.empty() && segment != ".") {
            out.append(out.empty() ? 0 : 1, '/').append(segment);
        }
    }
    if (has_scheme(out)) { // "./c:a" is a valid path, but its shortest form is not
        return decode_error("URI with a scheme is not allowed; use a relative path");
    }
    return out.empty() ? Decoded<std::string>(decode_error("path names no file")) : Decoded<std::string>(out);
}

Decoded<std::string> path_of_uri(std::string_view uri) {
    if (has_scheme(uri)) {
        return decode_error("URI with a scheme is not allowed; use a relative path");
    }
    return decode_percent(uri).and_then([](const std::string& path) { return check_relative_path(path); });
}

} // namespace fieldcast::scene
