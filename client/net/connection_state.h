// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/connection.h"

#include <grpcpp/grpcpp.h>

namespace fieldcast::client::net {

struct Connection::State {
    std::shared_ptr<grpc::Channel> channel;
    std::string token; ///< empty: none

    /// Call it for every call before it starts.
    void prepare(grpc::ClientContext& context) const;
};

/// The one place where gRPC's status becomes ours. `what` names the call for people.
NetError to_error(const std::string& what, const grpc::Status& status);

} // namespace fieldcast::client::net
