// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/web/limits.h"
#include "server/web/message.h"

#include <memory>
#include <tl/expected.hpp>

namespace fieldcast::web {

/// A request, or the answer to a malformed one.
using ReadRequest = tl::expected<Request, Answer>;

/// Parses one HTTP/1.0 or 1.1 request incrementally.
class RequestReader {
public:
    explicit RequestReader(const Limits& limits);
    ~RequestReader();

    /// Parses the next bytes. Returns nothing until the request is complete, body included; do not call it afterwards.
    /// Bytes after the request are ignored.
    std::optional<ReadRequest> put(std::string_view bytes);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::web
