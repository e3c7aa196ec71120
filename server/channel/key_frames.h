// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

namespace fieldcast::channel {

/// Chooses the key frames that all clients of a channel share: the first frame, then at least one per second. Cuts, and
/// clients that lack the last one, cause early key frames, at most one per half a second.
class KeyFrames {
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    static constexpr std::chrono::milliseconds kLongestGroup{1000};
    static constexpr std::chrono::milliseconds kShortestGroup{500};

    /// Whether the next frame, encoded at `now`, is a key frame. `is_wanted`: an early one would help.
    bool next(TimePoint now, bool is_wanted) {
        const bool is_key = !last_ || now - *last_ >= (is_wanted ? kShortestGroup : kLongestGroup);
        if (is_key) {
            last_ = now;
        }
        return is_key;
    }

private:
    std::optional<TimePoint> last_;
};

} // namespace fieldcast::channel
