// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <grpcpp/support/status.h>
#include <string>

namespace fieldcast::service {

/// Why a call fails. The only place where status codes are chosen is `to_status`.
enum class Problem {
    kInvalid,         ///< the caller sent something that is never right
    kNotFound,        ///< it does not exist here
    kOutOfRange,      ///< beyond the end
    kExhausted,       ///< a limit is reached; later it may work
    kUnavailable,     ///< the server is going away
    kUnauthenticated, ///< the caller does not show who it is
    kForbidden,       ///< the caller is known and may not
    kTooLate,         ///< the caller missed a deadline of the protocol
    kOurBug,          ///< the server failed
};

grpc::Status to_status(Problem problem, const std::string& message);

} // namespace fieldcast::service
