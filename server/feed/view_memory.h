// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/selection.h"

#include <atomic>
#include <memory>
#include <optional>
#include <string>

// Memory of the device that clients make the server allocate: what views need while they are made and from frame to
// frame.
namespace fieldcast::feed {

/// A budget in bytes, shared by all channels and own cameras of a device. Thread-safe.
class ViewMemory {
public:
    explicit ViewMemory(std::uint64_t limit_bytes) : limit_(limit_bytes) {}

    /// Before anything is taken.
    void set_limit(std::uint64_t bytes) { limit_ = bytes; }
    std::uint64_t limit() const { return limit_; }
    std::uint64_t used() const { return used_; }

    /// False: it does not fit, and nothing was taken.
    bool take(std::uint64_t bytes);
    void give_back(std::uint64_t bytes) { used_ -= bytes; }

private:
    std::atomic<std::uint64_t> limit_;
    std::atomic<std::uint64_t> used_ = 0;
};

/// What one channel has of the budget, by sets of views of the same geometry, field of view and size. What nobody wants
/// any more counts until the channel has given its memory back. Not thread-safe.
class HeldViews {
public:
    /// `memory` may be null: no limit.
    HeldViews(std::shared_ptr<ViewMemory> memory, std::uint64_t bytes_per_pixel)
        : memory_(std::move(memory)), bytes_per_pixel_(bytes_per_pixel) {}
    ~HeldViews();
    HeldViews(const HeldViews&) = delete;
    HeldViews& operator=(const HeldViews&) = delete;

    /// From now on these views are wanted, whatever their encoding. Otherwise the problem, with the numbers, and all
    /// stays as it was; less than before is always possible.
    std::optional<std::string> want(const Demand& demand);

    /// Whether more is held than wanted.
    bool has_surplus() const { return bytes_of(held_) > bytes_of(wanted_); }
    const std::vector<ViewDemand>& wanted() const { return wanted_; }

    /// The channel holds `kept` at most.
    void settle(const std::vector<ViewDemand>& kept);

private:
    std::uint64_t bytes_of(const std::vector<ViewDemand>& sets) const;

    std::shared_ptr<ViewMemory> memory_;
    std::uint64_t bytes_per_pixel_ = 0;
    std::vector<ViewDemand> wanted_; ///< without encoding
    std::vector<ViewDemand> held_;   ///< of each set the larger of what is wanted and what the channel has
};

} // namespace fieldcast::feed
