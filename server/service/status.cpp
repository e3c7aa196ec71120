// SPDX-License-Identifier: Apache-2.0
#include "server/service/status.h"

namespace fieldcast::service {

grpc::Status to_status(Problem problem, const std::string& message) {
    switch (problem) {
    case Problem::kInvalid:
        return {grpc::StatusCode::INVALID_ARGUMENT, message};
    case Problem::kNotFound:
        return {grpc::StatusCode::NOT_FOUND, message};
    case Problem::kOutOfRange:
        return {grpc::StatusCode::OUT_OF_RANGE, message};
    case Problem::kExhausted:
        return {grpc::StatusCode::RESOURCE_EXHAUSTED, message};
    case Problem::kUnavailable:
        return {grpc::StatusCode::UNAVAILABLE, message};
    case Problem::kUnauthenticated:
        return {grpc::StatusCode::UNAUTHENTICATED, message};
    case Problem::kForbidden:
        return {grpc::StatusCode::PERMISSION_DENIED, message};
    case Problem::kTooLate:
        return {grpc::StatusCode::DEADLINE_EXCEEDED, message};
    case Problem::kOurBug:
        break;
    }
    return {grpc::StatusCode::INTERNAL, message};
}

} // namespace fieldcast::service
