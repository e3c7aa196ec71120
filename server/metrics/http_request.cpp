// SPDX-License-Identifier: Apache-2.0
// As much of RFC 9110 and 9112 as a scrape needs.
#include "server/metrics/http_request.h"

#include <algorithm>
#include <cctype>

namespace fieldcast::metrics {

namespace {

constexpr std::string_view kLineEnd = "\r\n";

/// Takes the first line off `text`; nothing if there is no line end.
std::optional<std::string_view> next_line(std::string_view& text) {
    const std::size_t end = text.find(kLineEnd);
    if (end == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + kLineEnd.size());
    return line;
}

bool is_equal_in_any_case(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b,
                              [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kSpace = " \t";
    const std::size_t begin = text.find_first_not_of(kSpace);
    return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

/// "GET /metrics?x HTTP/1.1"
std::optional<HttpRequest> parse_request_line(std::string_view line) {
    const std::size_t first = line.find(' ');
    const std::size_t second = line.rfind(' ');
    if (first == std::string_view::npos || first == 0 || second <= first + 1 ||
        !line.substr(second + 1).starts_with("HTTP/1.")) {
        return std::nullopt;
    }
    const std::string_view target = line.substr(first + 1, second - first - 1);
    if (!target.starts_with('/') || target.find(' ') != std::string_view::npos) {
        return std::nullopt;
    }
    return HttpRequest{.method = std::string(line.substr(0, first)),
                       .path = std::string(target.substr(0, target.find('?'))),
                       .authorization = std::nullopt};
}

std::string_view reason_of(int status) {
    switch (status) {
    case 200:
        return "OK";
    case 400:
        return "Bad Request";
    case 401:
        return "Unauthorized";
    case 403:
        return "Forbidden";
    case 404:
        return "Not Found";
    case 405:
        return "Method Not Allowed";
    default:
        return "Internal Server Error";
    }
}

} // namespace

std::optional<HttpRequest> parse_http_request(std::string_view head) {
    const auto first = next_line(head);
    auto request = first ? parse_request_line(*first) : std::nullopt;
    while (request) {
        const auto line = next_line(head);
        if (line && line->empty()) {
            return request;
        }
        const std::size_t colon = line ? line->find(':') : std::string_view::npos;
        if (colon == std::string_view::npos || colon == 0) {
            return std::nullopt;
        }
        if (is_equal_in_any_case(line->substr(0, colon), "authorization")) {
            if (request->authorization) {
                return std::nullopt;
            }
            request->authorization = std::string(trimmed(line->substr(colon + 1)));
        }
    }
    return std::nullopt;
}

std::string http_answer(int status, std::string_view content_type, std::string_view body, bool has_body) {
    std::string text = "HTTP/1.1 " + std::to_string(status) + " " + std::string(reason_of(status)) + "\r\n";
    text += "Content-Type: " + std::string(content_type) + "\r\n";
    text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    text += status == 401 ? "WWW-Authenticate: Bearer\r\n" : "";
    text += status == 405 ? "Allow: GET, HEAD\r\n" : "";
    text += "Connection: close\r\n\r\n";
    return has_body ? text + std::string(body) : text;
}

} // namespace fieldcast::metrics
