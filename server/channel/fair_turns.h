// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

// Who may use the device next, when several channels share it.
// Follows: P. Goyal, H. M. Vin, H. Cheng. Start-time Fair Queueing: A Scheduling Algorithm for Integrated Services
// Packet Switching Networks. SIGCOMM 1996. Section 2.
// Differs: what a turn costs is known only after it, so its finish tag is; and the device waits a little for who has
// less and has just let go, as S. Iyer, P. Druschel. Anticipatory Scheduling. SOSP 2001, does for disks: a channel asks
// for its next turn only after it has handed on the frame of the last one.
namespace fieldcast::channel {

/// Gives out turns so that everybody who always wants one gets the same time, however long single turns are. Who was
/// away has saved up nothing. Not thread-safe; `now` must not go backwards.
class FairTurns {
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = TimePoint::duration;
    using Id = std::uint64_t; ///< > 0

    Id join();
    void leave(Id id);

    /// From now on `id` waits, until `begin` or `give_up`.
    void want(Id id);
    void give_up(Id id);

    /// Whether `id`, which waits, may begin at `now`.
    bool may_begin(Id id, TimePoint now) const;

    /// When it is worth asking again although nobody has done anything; empty: only then.
    std::optional<TimePoint> ask_again(Id id, TimePoint now) const;

    void begin(Id id, TimePoint now);
    void end(Id id, TimePoint now);

private:
    struct Member {
        Duration start{};  ///< tag of its next turn: time that it has had, as if it had always been there
        Duration finish{}; ///< tag of the end of its last turn
        Duration cost{};   ///< of its last turn
        TimePoint ended{}; ///< the moment of that
        bool is_waiting = false;
        bool has_turned = false; ///< there was a last turn
    };

    /// Somebody with a lower tag is about to come back: until then.
    TimePoint patience_ends(const Member& asking) const;
    bool is_before(Id id, const Member& member) const; ///< another one that waits is to go first

    std::map<Id, Member> members_;
    std::optional<Id> running_;
    TimePoint begun_{};
    Duration virtual_time_{}; ///< start tag of the turn begun last
    Id last_id_ = 0;
};

} // namespace fieldcast::channel
