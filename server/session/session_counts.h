// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"
#include "server/session/drop_counts.h"

#include <cstdint>
#include <map>

namespace fieldcast::session {

/// Number of level changes of one session, by direction.
struct AdaptationCounts {
    std::uint64_t down = 0;
    std::uint64_t up = 0;
};

/// Counters of one session since it began.
struct SessionCounts {
    std::uint64_t frames_sent = 0; ///< completely sent
    std::uint64_t bytes_sent = 0;
    std::uint64_t frames_failed = 0; ///< sent, but the client could not decode them
    std::uint64_t refusals = 0;      ///< refused Configure messages
    AdaptationCounts adaptations;
    DropCounts drops;
    std::map<wire::PlaneChoice, std::uint64_t> plane_bytes; ///< payload of complete frames; views count as kColour
};

/// What was counted between two moments of the same session.
SessionCounts difference(const SessionCounts& later, const SessionCounts& earlier);

} // namespace fieldcast::session
