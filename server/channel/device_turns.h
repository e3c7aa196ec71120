// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/channel/fair_turns.h"

#include <condition_variable>
#include <optional>
#include <stop_token>
#include <utility>

namespace fieldcast::channel {

/// Channels take turns at one device, a frame each. Thread-safe.
///
///     DevicePlace place(turns);                            // of a channel
///     if (const auto turn = place.wait(stop)) { render(); } // the turn ends with its scope
class DeviceTurns {
private:
    friend class DevicePlace;
    friend class DeviceTurn;
    std::condition_variable changed_;
    Guarded<FairTurns> turns_;
};

/// The right to use the device, for as long as this lives.
class DeviceTurn {
public:
    DeviceTurn(DeviceTurn&& other) noexcept : turns_(std::exchange(other.turns_, nullptr)), id_(other.id_) {}
    DeviceTurn& operator=(DeviceTurn&&) = delete;
    ~DeviceTurn();

private:
    friend class DevicePlace;
    DeviceTurn(DeviceTurns& turns, FairTurns::Id id) : turns_(&turns), id_(id) {}

    DeviceTurns* turns_; ///< null: moved away
    FairTurns::Id id_;
};

/// The place of one channel among those that share a device. `turns` must outlive it; it must outlive its turns.
class DevicePlace {
public:
    explicit DevicePlace(DeviceTurns& turns) : turns_(turns), id_(turns.turns_.lock()->join()) {}
    DevicePlace(const DevicePlace&) = delete;
    DevicePlace& operator=(const DevicePlace&) = delete;
    ~DevicePlace();

    /// Sleeps until it is our turn. Empty: `stop` was requested.
    std::optional<DeviceTurn> wait(const std::stop_token& stop);

private:
    DeviceTurns& turns_;
    const FairTurns::Id id_;
};

} // namespace fieldcast::channel
