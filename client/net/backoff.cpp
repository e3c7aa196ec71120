// SPDX-License-Identifier: Apache-2.0
#include "client/net/backoff.h"

#include <algorithm>

namespace fieldcast::client::net {

std::chrono::milliseconds Backoff::next() {
    std::uniform_int_distribution<std::int64_t> wait(ceiling_.count() / 2, ceiling_.count());
    const std::chrono::milliseconds chosen(wait(random_));
    ceiling_ = std::min(ceiling_ * 2, kLongest);
    return chosen;
}

} // namespace fieldcast::client::net
