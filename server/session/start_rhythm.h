// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/credits.h"

#include <optional>

namespace fieldcast::session {

/// How often frames of one client can be begun, whatever holds them up: its acknowledgements, its network, or nothing.
class StartRhythm {
public:
    void begun(TimePoint now) {
        if (last_) {
            const auto between = now - *last_;
            between_ += between_ == TimePoint::duration(0) ? between : (between - between_) / kNewest;
        }
        last_ = now;
    }

    /// When the next one is likely to be begun; it may be in the past.
    TimePoint next(TimePoint now) const { return last_.value_or(now) + between_; }

private:
    static constexpr int kNewest = 4; ///< a new one counts for a quarter

    std::optional<TimePoint> last_;
    TimePoint::duration between_{};
};

} // namespace fieldcast::session
