// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/http_request.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

#include <algorithm>

namespace fieldcast::fuzz {

void http_request(Bytes input) {
    const std::string_view head = as_text(input.first(std::min(input.size(), metrics::kMaxHeadBytes)));
    const auto request = metrics::parse_http_request(head);
    if (request) {
        FC_ASSERT(!request->method.empty() && request->path.starts_with('/'), "a request asks for something");
        FC_ASSERT(request->path.find('?') == std::string::npos, "paths have no query");
        FC_ASSERT(request->authorization.value_or("").find("\r\n") == std::string::npos, "a header is one line");
    }
}

} // namespace fieldcast::fuzz
