// SPDX-License-Identifier: Apache-2.0
#include "server/session/budget.h"

namespace fieldcast::session {

bool Budget::take(std::uint64_t amount) {
    if (!take_here(amount)) {
        return false;
    }
    if (parent_ != nullptr && !parent_->take(amount)) {
        *used_.lock() -= amount;
        return false;
    }
    return true;
}

bool Budget::take_here(std::uint64_t amount) {
    auto used = used_.lock();
    const bool fits = *used <= limit_ && amount <= limit_ - *used;
    if (!fits && *used != 0) {
        return false;
    }
    *used += amount;
    return true;
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
