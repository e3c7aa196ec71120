// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <grpcpp/support/status.h>
#include <string>

namespace fieldcast::service {

/// Why a call fails. Status codes are chosen in `to_status` only.
enum class Problem {
    kInvalid,         ///< the request is never valid
    kNotFound,        ///< the server does not have it
    kOutOfRange,      ///< beyond the end of the data
    kExhausted,       ///< a limit is reached; a later attempt may succeed
    kUnavailable,     ///< the server is shutting down
    kUnauthenticated, ///< the caller has no valid token
    kForbidden,       ///< the caller's role does not allow the call
    kTooLate,         ///< the caller missed a deadline of the protocol
    kOurBug,          ///< an internal error of the server
};

grpc::Status to_status(Problem problem, const std::string& message);

} // namespace fieldcast::service
