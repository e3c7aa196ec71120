// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

namespace fieldcast::session {

/// The part of `total` that is kept for peers that hold nothing yet: an eighth, at least 1. It is 0 if one peer may
/// hold the whole total.
constexpr std::uint64_t newcomers_reserve(std::uint64_t total, std::uint64_t of_one_peer) {
    return of_one_peer >= total ? 0 : std::max<std::uint64_t>(total / 8, 1);
}

/// An amount that several holders share. With a parent it is part of a larger amount, whose newcomers' reserve is kept
/// for budgets that hold nothing yet. Thread-safe.
///
///     const auto total = std::make_shared<Budget>(1U << 30U);
///     const auto of_peer = std::make_shared<Budget>(1U << 20U, total);
///     Share share(of_peer);
///     if (!share.resize(bytes)) { wait(); }
class Budget {
public:
    explicit Budget(std::uint64_t limit, std::shared_ptr<Budget> parent = nullptr)
        : limit_(limit), parent_(std::move(parent)) {}

    /// Takes all of `amount` from this budget and its parents, or nothing: false. While the budget is unused, an amount
    /// above its limit is granted, too, so that a frame larger than the limit can still be sent alone.
    bool take(std::uint64_t amount);
    void give_back(std::uint64_t amount); ///< that was taken; also to the parents

    std::uint64_t used() { return *used_.lock(); }
    std::uint64_t limit() const { return limit_; }

private:
    /// Takes `amount` from this budget alone. Returns what was used before; empty: it does not fit into `limit`.
    std::optional<std::uint64_t> take_here(std::uint64_t amount, std::uint64_t limit);
    bool take_within(std::uint64_t amount, std::uint64_t limit); ///< `take` with another limit for this budget

    const std::uint64_t limit_;
    const std::shared_ptr<Budget> parent_;
    Guarded<std::uint64_t> used_;
};

/// The amount that one holder has taken from a budget; given back when destroyed.
class Share {
public:
    Share() = default; ///< without a budget: never refused
    explicit Share(std::shared_ptr<Budget> budget) : budget_(std::move(budget)) {}
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    ~Share() { resize(0); }

    /// Holds `amount` from now on. False: the budget does not allow it, and the share stays as it was. A smaller amount
    /// is always allowed.
    bool resize(std::uint64_t amount);

private:
    std::shared_ptr<Budget> budget_; ///< null: no limit
    std::uint64_t amount_ = 0;
};

/// The budgets that all sessions of one peer share.
struct PeerBudgets {
    std::shared_ptr<Budget> bytes = nullptr;   ///< in flight; null: no limit
    std::shared_ptr<Budget> pixels = nullptr;  ///< of views that the server makes for the peer; null: no limit
    std::shared_ptr<Budget> cameras = nullptr; ///< own cameras of the peer's clients; null: no limit
};

} // namespace fieldcast::session
