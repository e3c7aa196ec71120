// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fieldcast::test {

/// What is wrong with a page that should be well-formed and self-contained, or nothing: elements that are not closed in
/// order, scripts, anything that a browser would fetch. (Quoted attributes without '>', as our pages have them.)
inline std::string html_problem(std::string_view html) {
    constexpr std::array<std::string_view, 4> kVoid{"meta", "br", "input", "!DOCTYPE"};
    constexpr std::array<std::string_view, 9> kFetched{"<script",  "<link",      "<iframe", "@import", "src=\"",
                                                       "url(http", "url(\"http", "url(/",   "href=\""};
    for (const std::string_view fetched : kFetched) {
        if (html.find(fetched) != std::string_view::npos) {
            return "contains " + std::string(fetched);
        }
    }
    std::vector<std::string> open;
    for (std::size_t begin = html.find('<'); begin != std::string_view::npos; begin = html.find('<', begin + 1)) {
        const std::size_t end = html.find('>', begin);
        if (end == std::string_view::npos) {
            return "a tag does not end";
        }
        const std::string_view tag = html.substr(begin + 1, end - begin - 1);
        const bool is_end = tag.starts_with('/');
        const std::string name(tag.substr(is_end ? 1 : 0, tag.find_first_of(" \n/", 1) - (is_end ? 1 : 0)));
        if (is_end) {
            if (open.empty() || open.back() != std::string(tag.substr(1))) {
                return "</" + std::string(tag.substr(1)) + "> closes " + (open.empty() ? "nothing" : open.back());
            }
            open.pop_back();
        } else if (!tag.ends_with('/') && std::ranges::find(kVoid, name) == kVoid.end()) {
            open.push_back(name);
        }
    }
    return open.empty() ? std::string() : open.back() + " is not closed";
}

} // namespace fieldcast::test
