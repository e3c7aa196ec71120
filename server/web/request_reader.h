// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/web/limits.h"
#include "server/web/message.h"

#include <memory>
#include <tl/expected.hpp>

namespace fieldcast::web {

/// A request, or what its sender is told because it is none.
using ReadRequest = tl::expected<Request, Answer>;

/// Reads one request of HTTP/1.0 or 1.1 from bytes as they come.
class RequestReader {
public:
    explicit RequestReader(const Limits& limits);
    ~RequestReader();

    /// Takes the next bytes. Nothing until the request is complete, body included; do not call it afterwards. Bytes
    /// after the request are left out.
    std::optional<ReadRequest> put(std::string_view bytes);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::web
