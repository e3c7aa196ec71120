// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "server/web/request_reader.h"
#include "tests/fuzz/input.h"

#include <algorithm>

namespace fieldcast::fuzz {

namespace {

/// What comes of `text` if it arrives in pieces of `piece` bytes.
std::optional<web::ReadRequest> read_in_pieces(std::string_view text, std::size_t piece) {
    web::RequestReader reader({});
    std::optional<web::ReadRequest> request;
    while (!request && !text.empty()) {
        request = reader.put(text.substr(0, piece));
        text.remove_prefix(std::min(piece, text.size()));
    }
    return request;
}

void expect_sane(const web::Request& request) {
    FC_ASSERT(!request.method.empty() && request.path.starts_with('/'), "a request asks for something");
    FC_ASSERT(request.path.find('?') == std::string::npos, "paths have no query");
    FC_ASSERT(request.authorization.value_or("").find("\r\n") == std::string::npos, "a header is one line");
}

} // namespace

void http_request(Bytes input) {
    const web::Limits limits;
    const std::size_t most_bytes = 2 * (limits.head_bytes + limits.body_bytes);
    const std::string_view text = as_text(input.first(std::min(input.size(), most_bytes)));
    const auto whole = read_in_pieces(text, most_bytes);
    const auto in_pieces = read_in_pieces(text, 7);
    FC_ASSERT(whole || text.size() <= limits.head_bytes + limits.body_bytes, "nobody sends for ever");
    const bool is_whole_request = whole && *whole;
    const bool is_request_in_pieces = in_pieces && *in_pieces;
    FC_ASSERT(!is_whole_request || is_request_in_pieces, "how the network cuts bytes changes nothing");
    if (is_whole_request) {
        expect_sane(**whole);
        FC_ASSERT((*whole)->path == (*in_pieces)->path && (*whole)->method == (*in_pieces)->method,
                  "how the network cuts bytes changes nothing");
    } else if (whole) {
        FC_ASSERT(whole->error().status == 400 || whole->error().status == 413, "only the sender is at fault");
    }
}

} // namespace fieldcast::fuzz
