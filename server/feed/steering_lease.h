// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

// The right to steer the camera of a channel: one client has it at a time, the others wait in a queue.
namespace fieldcast::feed {

/// Right of a client at a camera that can be steered.
enum class SteeringRight : std::uint8_t {
    kNone,
    kSteer, ///< while no other client steers
    kTake,  ///< also takes the camera from the client that steers
};

/// A client that may ask to steer.
struct Steerer {
    std::string name; ///< shown to the other clients
    SteeringRight right = SteeringRight::kNone;
};

/// How urgently a client asks to steer.
enum class SteeringUrgency : std::uint8_t {
    kNow,  ///< now or not at all
    kWait, ///< now, or after waiting in the queue
    kTake, ///< now, even from another client; needs SteeringRight::kTake
};

/// The client steers from now on.
struct SteeringGrant {
    std::uint64_t lease = 0; ///< number of the lease, > 0, increases

    bool operator==(const SteeringGrant&) const = default;
};

/// The client's request was denied.
struct SteeringDenial {
    enum class Reason : std::uint8_t { kRoleTooLow, kHeld };
    Reason reason = Reason::kHeld;
    std::string holder;      ///< name of the client that steers; empty: none
    bool is_waiting = false; ///< the client is in the queue
    std::uint32_t ahead = 0; ///< clients before it in the queue

    bool operator==(const SteeringDenial&) const = default;
};

/// The client's lease has ended.
struct SteeringLoss {
    enum class Reason : std::uint8_t { kReleased, kHandedOver, kTaken, kExpired };
    std::uint64_t lease = 0;
    Reason reason = Reason::kReleased;

    bool operator==(const SteeringLoss&) const = default;
};

using SteeringNotice = std::variant<SteeringGrant, SteeringDenial, SteeringLoss>;

/// The right to steer one camera. The holder keeps it while it renews it in time. Not thread-safe; `now` must not go
/// backwards. Every call with `now` first checks whether the lease has expired.
class SteeringLease {
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Id = std::uint64_t; ///< of a steerer, > 0

    /// `length`: time after which a lease expires unless it is renewed.
    explicit SteeringLease(std::chrono::milliseconds length) : length_(length) {}

    Id join(Steerer steerer);         ///< adds a client
    void leave(Id id, TimePoint now); ///< removes a client; its lease and its place in the queue end

    /// Asks for the lease; the answer is a notice, a grant or a denial.
    void request(Id id, SteeringUrgency urgency, TimePoint now);

    /// Prolongs the lease. False: `id` does not hold it.
    bool renew(Id id, TimePoint now);

    /// Gives up the lease or the place in the queue. The client that has waited longest gets the lease.
    void release(Id id, TimePoint now);

    /// Hands the lease to the client that has waited longest. If none waits, the holder keeps it until another client
    /// asks.
    void offer(Id id, TimePoint now);

    void look_at_clock(TimePoint now); ///< ends the lease if it has expired

    std::optional<SteeringNotice> next_notice(Id id); ///< for `id`, oldest first; empty: none
    std::uint64_t lease() const { return holder_ ? lease_ : 0; } ///< number of the lease that is held; 0: none

private:
    struct Member {
        Steerer steerer;
        std::deque<SteeringNotice> notices;
    };

    void grant(Id id, TimePoint now);
    void dismiss(SteeringLoss::Reason reason); ///< takes the lease from the holder
    void grant_next(TimePoint now);
    void deny(Id id, SteeringDenial::Reason reason);
    void remove_from_queue(Id id);

    const std::chrono::milliseconds length_;
    std::map<Id, Member> members_;
    std::deque<Id> queue_;
    std::optional<Id> holder_;
    bool is_offered_ = false;
    std::uint64_t lease_ = 0;
    TimePoint ends_{};
    Id last_id_ = 0;
};

} // namespace fieldcast::feed
