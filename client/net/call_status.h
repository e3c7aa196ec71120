// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/net_error.h"

#include <grpcpp/support/status.h>
#include <string>

namespace fieldcast::client::net {

/// Converts gRPC's status of a failed call to our error; the only place that does. `what` names the call for people.
NetError to_error(const std::string& what, const grpc::Status& status);

} // namespace fieldcast::client::net
