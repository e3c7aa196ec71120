// SPDX-License-Identifier: Apache-2.0
#include "client/net/backoff.h"

#include <algorithm>

namespace fieldcast::client::net {

std::chrono::milliseconds Backoff::next(Obstacle obstacle) {
    unreachable_count_ += obstacle == Obstacle::kUnreachable ? 1 : 0;
    const bool is_quick = obstacle == Obstacle::kUnreachable && unreachable_count_ <= kQuickAttempts;
    ceiling_ = std::min(ceiling_, is_quick ? kLongestUnreachable : kLongest);
    std::uniform_int_distribution<std::int64_t> wait(ceiling_.count() / 2, ceiling_.count());
    const std::chrono::milliseconds chosen(wait(random_));
    ceiling_ = std::min(ceiling_ * 2, kLongest);
    return chosen;
}

void Backoff::reset() {
    ceiling_ = kFirst;
    unreachable_count_ = 0;
}

} // namespace fieldcast::client::net
