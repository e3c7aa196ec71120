// SPDX-License-Identifier: Apache-2.0
#include "server/service/grpc_version.h"

#include <grpcpp/grpcpp.h>

namespace fieldcast::service {

std::string grpc_version() {
    return grpc::Version();
}

} // namespace fieldcast::service
