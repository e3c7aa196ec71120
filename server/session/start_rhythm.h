// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/credits.h"

#include <optional>

namespace fieldcast::session {

/// Averages the time between the starts of one client's frames, whether acknowledgements, the network or nothing limits
/// them. Not thread-safe.
class StartRhythm {
public:
    /// A frame is begun.
    void begun(TimePoint now) {
        if (last_) {
            const auto between = now - *last_;
            between_ += between_ == TimePoint::duration(0) ? between : (between - between_) / kNewest;
        }
        last_ = now;
    }

    /// Expected start of the next frame; may be in the past.
    TimePoint next(TimePoint now) const { return last_.value_or(now) + between_; }

private:
    static constexpr int kNewest = 4; ///< the newest interval has the weight 1/4

    std::optional<TimePoint> last_;
    TimePoint::duration between_{};
};

} // namespace fieldcast::session
