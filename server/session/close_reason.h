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
    kInvalid,       ///< the client sent something that is no message
    kNotConfigured, ///< no acceptable Configure in time
    kStalled,       ///< a frame was not acknowledged in time
    kNotReading,    ///< a message could not be written in time
    kFlooding,      ///< the client sent too many messages
    kDrained,       ///< the server is going away
    kRevoked,       ///< its token has gone
    kFailed,        ///< our bug, or the session's own camera failed
};
inline constexpr std::size_t kCloseReasonCount = 10;
inline constexpr std::array<std::string_view, kCloseReasonCount> kCloseReasonNames{
    "finished",    "cancelled", "invalid", "not_configured", "stalled",
    "not_reading", "flooding",  "drained", "revoked",        "failed"};

inline std::string_view to_text(CloseReason reason) {
    return kCloseReasonNames.at(static_cast<std::size_t>(reason));
}

} // namespace fieldcast::session
