// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"
#include "server/session/drop_counts.h"

#include <cstdint>
#include <map>

namespace fieldcast::session {

/// What happened to one client since its session began.
struct SessionCounts {
    std::uint64_t frames_sent = 0; ///< completely
    std::uint64_t bytes_sent = 0;
    std::uint64_t frames_failed = 0; ///< the client could not decode them
    std::uint64_t refusals = 0;      ///< of a Configure
    DropCounts drops;
    std::map<wire::PlaneChoice, std::uint64_t> plane_bytes; ///< payload of complete frames; views count as kColour
};

/// What happened between two moments of the same session.
SessionCounts difference(const SessionCounts& later, const SessionCounts& earlier);

} // namespace fieldcast::session
