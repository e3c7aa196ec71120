// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"
#include "server/session/drop_counts.h"

#include <cstdint>
#include <map>

namespace fieldcast::session {

/// Changes of one session that the server made by itself.
struct AdaptationCounts {
    std::uint64_t down = 0;
    std::uint64_t up = 0;
};

/// What happened to one client since its session began.
struct SessionCounts {
    std::uint64_t frames_sent = 0; ///< completely
    std::uint64_t bytes_sent = 0;
    std::uint64_t frames_failed = 0; ///< the client could not decode them
    std::uint64_t refusals = 0;      ///< of a Configure
    AdaptationCounts adaptations;
    DropCounts drops;
    std::map<wire::PlaneChoice, std::uint64_t> plane_bytes; ///< payload of complete frames; views count as kColour
};

/// What happened between two moments of the same session.
SessionCounts difference(const SessionCounts& later, const SessionCounts& earlier);

} // namespace fieldcast::session
