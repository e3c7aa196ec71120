// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/feed/steering_lease.h"

#include <glm/glm.hpp>
#include <memory>

namespace fieldcast::feed {

/// Camera pose that the holder of a lease chose.
struct SteeredPose {
    std::uint64_t lease = 0;
    std::uint64_t sequence = 0; ///< increases within a lease
    std::int64_t client_time_ns = 0; ///< when the client chose the pose, on its steady clock
    glm::mat4 world_from_camera{1.0F}; ///< rigid
    bool cut = false; ///< a jump, not a movement
};

class SteeringSeat;

/// A camera that clients steer: the lease, and the holder's newest pose. Thread-safe.
///
///     render loop:  pose = steering->sample();
///     session:      seat = Steering::join(steering, {name, right});  seat.request(…);  … seat.steer(pose) …
class Steering {
public:
    using TimePoint = SteeringLease::TimePoint;

    explicit Steering(std::chrono::milliseconds lease_length)
        : lease_length_(lease_length), state_(State{SteeringLease(lease_length), std::nullopt}) {}

    std::chrono::milliseconds lease_length() const { return lease_length_; }

    /// Adds a client, which may then request the lease.
    static SteeringSeat join(const std::shared_ptr<Steering>& steering, Steerer steerer);

    /// The newest pose of all clients; empty: the camera was never steered. Its `cut` is set if any pose since the last
    /// call was a jump.
    std::optional<SteeredPose> sample();

private:
    friend class SteeringSeat;
    struct State {
        SteeringLease lease;
        std::optional<SteeredPose> newest;
    };

    const std::chrono::milliseconds lease_length_;
    Guarded<State> state_;
};

/// One client's membership of a Steering, and its access to the lease. Leaves when destroyed. Not thread-safe.
class SteeringSeat {
public:
    using TimePoint = Steering::TimePoint;

    SteeringSeat() = default; ///< at no camera: only `steering` and `leave` may be called
    SteeringSeat(SteeringSeat&& other) noexcept : steering_(std::move(other.steering_)), id_(other.id_) {}
    SteeringSeat& operator=(SteeringSeat&& other) noexcept;
    ~SteeringSeat() { leave(); }

    const std::shared_ptr<Steering>& steering() const { return steering_; } ///< null: at no camera

    void request(SteeringUrgency urgency, TimePoint now); ///< as SteeringLease::request
    void release(TimePoint now);                          ///< as SteeringLease::release
    void offer(TimePoint now);                            ///< as SteeringLease::offer

    /// Renews the lease. False: the client does not hold it.
    bool renew(TimePoint now);

    /// Sets the newest pose and renews the lease. A pose whose sequence number does not increase is ignored.
    /// `pose.lease` is set here. False: the client does not hold the lease.
    bool steer(SteeredPose pose, TimePoint now);

    /// The next notice for the client, oldest first; empty: none.
    std::optional<SteeringNotice> next_notice(TimePoint now);

    /// Gives up the lease and the place in the queue.
    void leave();

private:
    friend class Steering;
    SteeringSeat(std::shared_ptr<Steering> steering, SteeringLease::Id id) : steering_(std::move(steering)), id_(id) {}

    std::shared_ptr<Steering> steering_;
    SteeringLease::Id id_ = 0;
};

} // namespace fieldcast::feed
