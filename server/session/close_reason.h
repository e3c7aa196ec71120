// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fieldcast::session {

/// Why a session ended.
enum class CloseReason : std::uint8_t {
    kFinished,      ///< the client half-closed
    kCancelled,     ///< the client cancelled, or the connection was lost
    kInvalid,       ///< the client sent bytes that are not a message
    kNotConfigured, ///< the client sent no acceptable Configure in time
    kStalled,       ///< a frame was not acknowledged in time
    kNotReading,    ///< a message could not be written in time
    kFlooding,      ///< the client sent too many messages
    kDrained,       ///< the server is shutting down
    kRevoked,       ///< the client's token was removed
    kFailed,        ///< a bug of the server, or the client's own camera failed
};
inline constexpr std::size_t kCloseReasonCount = 10;
inline constexpr std::array<std::string_view, kCloseReasonCount> kCloseReasonNames{
    "finished",    "cancelled", "invalid", "not_configured", "stalled",
    "not_reading", "flooding",  "drained", "revoked",        "failed"};

/// The word of metrics and logs.
inline std::string_view to_text(CloseReason reason) {
    return kCloseReasonNames.at(static_cast<std::size_t>(reason));
}

} // namespace fieldcast::session
