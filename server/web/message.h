// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast::web {

/// The parts of a request that routes use.
struct Request {
    std::string method; ///< as sent, not checked
    std::string path;   ///< begins with '/'; without query
    std::optional<std::string> authorization;
};

inline constexpr std::string_view kPlainText = "text/plain; charset=utf-8";

struct Answer {
    int status = 200;
    std::string content_type{kPlainText};
    std::string body;
};

/// The bytes of a complete answer, after which the connection ends. The answer to HEAD has no body.
std::string text_of(const Answer& answer, bool is_head);

} // namespace fieldcast::web
