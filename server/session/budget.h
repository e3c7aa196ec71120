// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

namespace fieldcast::session {

/// How much of a total is kept for peers that have nothing of it yet: an eighth, or nothing where one peer may have all.
constexpr std::uint64_t newcomers_reserve(std::uint64_t total, std::uint64_t of_one_peer) {
    return of_one_peer >= total ? 0 : std::max<std::uint64_t>(total / 8, 1);
}

/// An amount that several holders share, as part of a larger one if it has a parent. The newcomers' reserve of the
/// parent goes to budgets that hold nothing yet. Thread-safe.
///
///     const auto total = std::make_shared<Budget>(1U << 30U);
///     const auto of_peer = std::make_shared<Budget>(1U << 20U, total);
///     Share share(of_peer);
///     if (!share.resize(bytes)) { wait(); }
class Budget {
public:
    explicit Budget(std::uint64_t limit, std::shared_ptr<Budget> parent = nullptr)
        : limit_(limit), parent_(std::move(parent)) {}

    /// All of `amount` from here and from the parents, or nothing. More than the limit is given while nobody holds
    /// anything, so that what is too large can still go alone.
    bool take(std::uint64_t amount);
    void give_back(std::uint64_t amount);

    std::uint64_t used() { return *used_.lock(); }
    std::uint64_t limit() const { return limit_; }

private:
    /// What was used before; empty: it does not fit into `limit`.
    std::optional<std::uint64_t> take_here(std::uint64_t amount, std::uint64_t limit);
    bool take_within(std::uint64_t amount, std::uint64_t limit);

    const std::uint64_t limit_;
    const std::shared_ptr<Budget> parent_;
    Guarded<std::uint64_t> used_;
};

/// What one holder has of a budget; given back when destroyed.
class Share {
public:
    Share() = default; ///< of nothing: never refused
    explicit Share(std::shared_ptr<Budget> budget) : budget_(std::move(budget)) {}
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    ~Share() { resize(0); }

    /// False: the budget does not allow it, and the share stays as it was. Less is always allowed.
    bool resize(std::uint64_t amount);

private:
    std::shared_ptr<Budget> budget_; ///< null: no limit
    std::uint64_t amount_ = 0;
};

/// What all sessions of one peer share.
struct PeerBudgets {
    std::shared_ptr<Budget> bytes = nullptr;   ///< in flight; null: no limit
    std::shared_ptr<Budget> pixels = nullptr;  ///< of views that the server makes; null: no limit
    std::shared_ptr<Budget> cameras = nullptr; ///< of clients that have one each; null: no limit
};

} // namespace fieldcast::session
