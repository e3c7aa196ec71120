// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/limits.h"

#include <grpcpp/server_builder.h>

namespace fieldcast::service {

/// What gRPC lets one connection do, and all of them together: sizes, streams, memory, threads, deadlines.
void set_transport_options(grpc::ServerBuilder& builder, const session::Limits& limits);

} // namespace fieldcast::service
