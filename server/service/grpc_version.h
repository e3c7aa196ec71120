// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace fieldcast::service {

/// Version of the gRPC library that this program is linked to at run time, as in "1.51.1".
std::string grpc_version();

} // namespace fieldcast::service
