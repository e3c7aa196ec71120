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

// Who steers the camera of a channel: one at a time, as long as it goes on; others wait in a queue.
namespace fieldcast::feed {

/// What somebody may do with a camera that can be steered.
enum class SteeringRight : std::uint8_t {
    kNone,
    kSteer, ///< when nobody else does
    kTake,  ///< also from whoever steers
};

/// Somebody who may ask to steer.
struct Steerer {
    std::string name; ///< for the others to see
    SteeringRight right = SteeringRight::kNone;
};

/// How somebody asks to steer.
enum class SteeringUrgency : std::uint8_t {
    kNow,  ///< now or not at all
    kWait, ///< now, or when it is my turn
    kTake, ///< now, whoever steers; needs SteeringRight::kTake
};

/// You steer from now on.
struct SteeringGrant {
    std::uint64_t lease = 0; ///< number of the lease, > 0, grows

    bool operator==(const SteeringGrant&) const = default;
};

/// You do not steer.
struct SteeringDenial {
    enum class Reason : std::uint8_t { kRoleTooLow, kHeld };
    Reason reason = Reason::kHeld;
    std::string holder;      ///< who does
    bool is_waiting = false; ///< you are in the queue
    std::uint32_t ahead = 0; ///< so many are in it before you

    bool operator==(const SteeringDenial&) const = default;
};

/// You have steered; you do not any more.
struct SteeringLoss {
    enum class Reason : std::uint8_t { kReleased, kHandedOver, kTaken, kExpired };
    std::uint64_t lease = 0;
    Reason reason = Reason::kReleased;

    bool operator==(const SteeringLoss&) const = default;
};

using SteeringNotice = std::variant<SteeringGrant, SteeringDenial, SteeringLoss>;

/// The right to steer one camera. Whoever holds it keeps it while it renews it in time. Not thread-safe; `now` must not
/// go backwards. Every call first looks whether the lease has run out.
class SteeringLease {
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Id = std::uint64_t; ///< of a steerer, > 0

    /// `length`: how long a lease lasts that is not renewed.
    explicit SteeringLease(std::chrono::milliseconds length) : length_(length) {}

    Id join(Steerer steerer); ///< somebody comes
    void leave(Id id, TimePoint now); ///< and goes: its lease and its place in the queue go with it

    /// Answered by notices: a grant or a denial.
    void request(Id id, SteeringUrgency urgency, TimePoint now);

    /// False: `id` does not hold the lease.
    bool renew(Id id, TimePoint now);

    /// Gives the lease, or the place in the queue, up. Who waits longest gets the lease.
    void release(Id id, TimePoint now);

    /// Gives the lease to who waits longest, or, if nobody does, to the next one who asks; until then it stays.
    void offer(Id id, TimePoint now);

    void look_at_clock(TimePoint now);

    std::optional<SteeringNotice> next_notice(Id id); ///< for `id`, oldest first
    std::uint64_t lease() const { return holder_ ? lease_ : 0; } ///< number of the one that is held; 0: none is

private:
    struct Member {
        Steerer steerer;
        std::deque<SteeringNotice> notices;
    };

    void grant(Id id, TimePoint now);
    void dismiss(SteeringLoss::Reason reason); ///< the holder
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
