// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/selection.h"

#include <atomic>
#include <memory>
#include <optional>
#include <string>

// Device memory that the server allocates for clients' views: while they are made, and from frame to frame.
namespace fieldcast::feed {

/// A budget in bytes, shared by all channels and own cameras of a device. Thread-safe.
class ViewMemory {
public:
    explicit ViewMemory(std::uint64_t limit_bytes) : limit_(limit_bytes) {}

    /// Must be called before anything is taken.
    void set_limit(std::uint64_t bytes) { limit_ = bytes; }
    std::uint64_t limit() const { return limit_; }
    std::uint64_t used() const { return used_; }

    /// Takes `bytes` from the budget. False: they do not fit, and nothing was taken.
    bool take(std::uint64_t bytes);
    void give_back(std::uint64_t bytes) { used_ -= bytes; }

private:
    std::atomic<std::uint64_t> limit_;
    std::atomic<std::uint64_t> used_ = 0;
};

/// The views of one channel that occupy device memory, in sets of the same geometry, field of view and size. Views that
/// no client wants any more count until the channel has freed their memory. Not thread-safe.
class HeldViews {
public:
    /// `memory` may be null: no limit.
    HeldViews(std::shared_ptr<ViewMemory> memory, std::uint64_t bytes_per_pixel)
        : memory_(std::move(memory)), bytes_per_pixel_(bytes_per_pixel) {}
    ~HeldViews();
    HeldViews(const HeldViews&) = delete;
    HeldViews& operator=(const HeldViews&) = delete;

    /// Sets the wanted views; their encoding does not matter. If they do not fit, nothing changes and the problem is
    /// returned, with the numbers. A smaller demand is always possible.
    std::optional<std::string> want(const Demand& demand);

    /// Whether more views are held than wanted.
    bool has_surplus() const { return bytes_of(held_) > bytes_of(wanted_); }
    const std::vector<ViewDemand>& wanted() const { return wanted_; }

    /// The channel has freed all views except `kept`; wanted views stay counted.
    void settle(const std::vector<ViewDemand>& kept);

private:
    std::uint64_t bytes_of(const std::vector<ViewDemand>& sets) const;

    std::shared_ptr<ViewMemory> memory_;
    std::uint64_t bytes_per_pixel_ = 0;
    std::vector<ViewDemand> wanted_; ///< without encoding
    std::vector<ViewDemand> held_;   ///< per set, the larger one of the wanted views and those in device memory
};

} // namespace fieldcast::feed
