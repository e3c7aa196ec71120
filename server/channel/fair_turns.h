// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

// Chooses the next user of a device that several channels share.
// Follows: P. Goyal, H. M. Vin, H. Cheng. Start-time Fair Queueing: A Scheduling Algorithm for Integrated Services
// Packet Switching Networks. SIGCOMM 1996. Section 2.
// Differs: a turn's cost, and so its finish tag, is known only after the turn. And the device waits briefly for a
// previous holder with a lower tag, as disks do in S. Iyer, P. Druschel. Anticipatory Scheduling. SOSP 2001: a channel
// requests its next turn only after it has handed on the frame of the last one.
namespace fieldcast::channel {

/// Grants turns so that members which always want one get equal time, however long single turns are. Time during which
/// a member wanted no turn earns it nothing. Not thread-safe; `now` must not go backwards.
class FairTurns {
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = TimePoint::duration;
    using Id = std::uint64_t; ///< > 0

    Id join();
    void leave(Id id);

    /// `id` waits from now on, until `begin` or `give_up`.
    void want(Id id);
    void give_up(Id id);

    /// Whether `id`, which waits, may begin at `now`.
    bool may_begin(Id id, TimePoint now) const;

    /// Time at which may_begin() may change by itself; empty: it changes only with another call.
    std::optional<TimePoint> ask_again(Id id, TimePoint now) const;

    void begin(Id id, TimePoint now);
    void end(Id id, TimePoint now);

private:
    struct Member {
        Duration start{};  ///< tag of its next turn: time used, counted as if it had always been a member
        Duration finish{}; ///< tag of the end of its last turn
        Duration cost{};   ///< of its last turn
        TimePoint ended{}; ///< end of its last turn
        bool is_waiting = false;
        bool has_turned = false; ///< there was a last turn
    };

    /// Time until which the device waits for a member with a lower tag to come back.
    TimePoint patience_ends(const Member& asking) const;
    bool is_before(Id id, const Member& member) const; ///< another waiting member goes first

    std::map<Id, Member> members_;
    std::optional<Id> running_;
    TimePoint begun_{};
    Duration virtual_time_{}; ///< start tag of the turn begun last
    Id last_id_ = 0;
};

} // namespace fieldcast::channel
