// SPDX-License-Identifier: Apache-2.0
#include "server/session/budget.h"

namespace fieldcast::session {

bool Budget::take(std::uint64_t amount) {
    return take_within(amount, limit_);
}

bool Budget::take_within(std::uint64_t amount, std::uint64_t limit) {
    const std::optional<std::uint64_t> before = take_here(amount, limit);
    if (!before) {
        return false;
    }
    if (parent_ == nullptr) {
        return true;
    }
    const std::uint64_t kept = *before == 0 ? 0 : newcomers_reserve(parent_->limit_, limit_);
    if (!parent_->take_within(amount, parent_->limit_ - kept)) {
        *used_.lock() -= amount;
        return false;
    }
    return true;
}

std::optional<std::uint64_t> Budget::take_here(std::uint64_t amount, std::uint64_t limit) {
    auto used = used_.lock();
    const bool fits = *used <= limit && amount <= limit - *used;
    if (!fits && *used != 0) {
        return std::nullopt;
    }
    *used += amount;
    return *used - amount;
}

void Budget::give_back(std::uint64_t amount) {
    *used_.lock() -= amount;
    if (parent_ != nullptr) {
        parent_->give_back(amount);
    }
}

bool Share::resize(std::uint64_t amount) {
    if (budget_ != nullptr && amount > amount_ && !budget_->take(amount - amount_)) {
        return false;
    }
    if (budget_ != nullptr && amount < amount_) {
        budget_->give_back(amount_ - amount);
    }
    amount_ = amount;
    return true;
}

} // namespace fieldcast::session
