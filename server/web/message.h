// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast::web {

/// What routes look at in a request.
struct Request {
    std::string method; ///< any word
    std::string path;   ///< begins with '/'; without query
    std::optional<std::string> authorization;
};

inline constexpr std::string_view kPlainText = "text/plain; charset=utf-8";

struct Answer {
    int status = 200;
    std::string content_type{kPlainText};
    std::string body;
};

/// A whole answer as it goes over the wire, after which the connection ends. HEAD gets no body.
std::string text_of(const Answer& answer, bool is_head);

} // namespace fieldcast::web
