// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <grpcpp/grpcpp.h>
#include <memory>
#include <string>

namespace fieldcast::client::net {

/// What a Connection consists of, for the calls of client/net.
struct ConnectionState {
    std::shared_ptr<grpc::Channel> channel;
    std::string token; ///< empty: none

    /// Adds the token. Call it for every call before the call starts.
    void prepare(grpc::ClientContext& context) const {
        if (!token.empty()) {
            context.AddMetadata("authorization", "Bearer " + token);
        }
    }
};

} // namespace fieldcast::client::net
