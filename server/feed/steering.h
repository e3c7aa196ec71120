// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/feed/steering_lease.h"

#include <glm/glm.hpp>
#include <memory>

namespace fieldcast::feed {

/// Where the holder of a lease wants the camera.
struct SteeredPose {
    std::uint64_t lease = 0;
    std::uint64_t sequence = 0; ///< grows within a lease
    std::int64_t client_time_ns = 0; ///< steady clock of the client, when it chose the pose
    glm::mat4 world_from_camera{1.0F}; ///< rigid
    bool cut = false; ///< a jump, not a movement
};

class SteeringSeat;

/// A camera that clients steer: the lease, and the newest pose of who holds it. Thread-safe.
///
///     render loop:  pose = steering->sample();
///     session:      seat = Steering::join(steering, {name, right});  seat.request(…);  … seat.steer(pose) …
class Steering {
public:
    using TimePoint = SteeringLease::TimePoint;

    explicit Steering(std::chrono::milliseconds lease_length)
        : lease_length_(lease_length), state_(State{SteeringLease(lease_length), std::nullopt}) {}

    std::chrono::milliseconds lease_length() const { return lease_length_; }

    static SteeringSeat join(const std::shared_ptr<Steering>& steering, Steerer steerer);

    /// The newest pose that anybody chose; empty: the camera was never steered. Its `cut` is set if it or one before
    /// it, since the last call, was a jump.
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

/// One client's place at a camera. Leaves when destroyed. For one thread at a time.
class SteeringSeat {
public:
    using TimePoint = Steering::TimePoint;

    SteeringSeat() = default; ///< at no camera: do nothing with it
    SteeringSeat(SteeringSeat&& other) noexcept : steering_(std::move(other.steering_)), id_(other.id_) {}
    SteeringSeat& operator=(SteeringSeat&& other) noexcept;
    ~SteeringSeat() { leave(); }

    const std::shared_ptr<Steering>& steering() const { return steering_; } ///< null: at no camera

    void request(SteeringUrgency urgency, TimePoint now);
    void release(TimePoint now);
    void offer(TimePoint now);

    /// False: it does not hold the lease.
    bool renew(TimePoint now);

    /// Newest wins; a pose whose sequence number does not grow is passed over. Renews the lease. `pose.lease` is set
    /// here. False: it does not hold the lease.
    bool steer(SteeredPose pose, TimePoint now);

    /// What happened to it, oldest first.
    std::optional<SteeringNotice> next_notice(TimePoint now);

    void leave();

private:
    friend class Steering;
    SteeringSeat(std::shared_ptr<Steering> steering, SteeringLease::Id id) : steering_(std::move(steering)), id_(id) {}

    std::shared_ptr<Steering> steering_;
    SteeringLease::Id id_ = 0;
};

} // namespace fieldcast::feed
