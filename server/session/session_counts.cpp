// SPDX-License-Identifier: Apache-2.0
#include "server/session/session_counts.h"

namespace fieldcast::session {

SessionCounts difference(const SessionCounts& later, const SessionCounts& earlier) {
    SessionCounts counts(later);
    counts.frames_sent -= earlier.frames_sent;
    counts.bytes_sent -= earlier.bytes_sent;
    counts.frames_failed -= earlier.frames_failed;
    counts.refusals -= earlier.refusals;
    counts.adaptations.down -= earlier.adaptations.down;
    counts.adaptations.up -= earlier.adaptations.up;
    counts.drops.subtract(earlier.drops);
    for (const auto& [choice, bytes] : earlier.plane_bytes) {
        counts.plane_bytes[choice] -= bytes;
    }
    return counts;
}

} // namespace fieldcast::session
