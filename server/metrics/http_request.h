// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast::metrics {

/// What we look at in a request of HTTP/1.0 or 1.1.
struct HttpRequest {
    std::string method;
    std::string path; ///< without query
    std::optional<std::string> authorization;
};

/// Largest head of a request, bytes.
inline constexpr std::size_t kMaxHeadBytes = 8192;

/// `head` is everything up to the empty line, with it. Nothing if it is not a request, or repeats Authorization.
std::optional<HttpRequest> parse_http_request(std::string_view head);

/// A whole answer, after which the connection ends. `body` is left out for HEAD.
std::string http_answer(int status, std::string_view content_type, std::string_view body, bool has_body);

} // namespace fieldcast::metrics
