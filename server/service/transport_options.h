// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/limits.h"

#include <grpcpp/server_builder.h>

namespace fieldcast::service {

/// gRPC's limits for one connection and for all of them: sizes, streams, memory, threads, deadlines.
void set_transport_options(grpc::ServerBuilder& builder, const session::Limits& limits);

} // namespace fieldcast::service
