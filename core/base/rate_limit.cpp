// SPDX-License-Identifier: Apache-2.0
#include "core/base/rate_limit.h"

#include <algorithm>

namespace fieldcast {

double RateLimit::left_at(TimePoint now) const {
    const double elapsed_s = std::chrono::duration<double>(std::max(now - at_, TimePoint::duration(0))).count();
    return std::min(rate_.burst, left_ + elapsed_s * rate_.per_second);
}

bool RateLimit::take(TimePoint now, double amount) {
    left_ = left_at(now);
    at_ = now;
    if (left_ < amount) {
        return false;
    }
    left_ -= amount;
    return true;
}

} // namespace fieldcast
