// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/due_schedule.h"
#include "client/load/scenario.h"
#include "client/load/tally.h"
#include "client/net/backoff.h"
#include "client/net/client_session.h"
#include "core/base/guarded.h"

#include <functional>
#include <optional>
#include <random>

namespace fieldcast::client::load {

/// One client of a group: connects, reads, leaves and returns as the group defines, and records its frames in a tally.
/// Belongs to one thread and does not block it, except until gRPC has released a cancelled stream.
class LoadClient {
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    struct Surroundings {
        const Scenario* scenario = nullptr;
        const Group* group = nullptr;
        Window window;
        WorkerPool* pool = nullptr; ///< decodes frames
        Guarded<Tally>* tally = nullptr;
        std::function<void()> on_change{}; ///< from any thread: call `run` soon
    };

    LoadClient(Surroundings surroundings, std::uint32_t seed, TimePoint starts_at);

    /// Does all pending work. Returns when to call it again at the latest.
    TimePoint run();

    /// Half-closes the stream and does not reconnect. The window ends now, unless it has ended before. Call it once.
    void leave_for_good();
    bool is_gone() const { return is_gone_; }

    /// The client's counts; complete after `leave_for_good`.
    ClientShare share() const { return share_; }

private:
    void open(TimePoint now);
    void close(TimePoint now);
    void come_back_at(TimePoint when);
    void leave(TimePoint now, std::chrono::milliseconds grace);
    void read();
    TimePoint next_run() const;

    void handle(const net::Agreement& agreement);
    void handle(const net::FrameArrived& frame);
    void handle(const net::FrameFailed& failed);
    void handle(const net::FrameAborted& aborted);
    void handle(const net::Refused& refused);
    void handle(const net::GoingAway& going);
    void handle(const net::SteeringNews&) {} // it never requests to steer
    void handle(const net::Ended& ended);
    void add_stages(const net::FrameArrived& frame, Tally& tally);
    void answer_due(const net::FrameArrived& frame, Tally& tally);
    void begin_due();
    void end_due(TimePoint now);
    Seconds due_period() const;
    void add_loss(const std::string& reason);
    void count_presence(TimePoint until);
    Seconds spread(Seconds mean);

    Surroundings all_;
    std::minstd_rand random_;
    net::Backoff backoff_;
    std::optional<net::Connection> connection_;
    std::optional<net::ClientSession> session_; ///< declared after the members that it uses
    std::optional<net::Agreement> agreement_;
    std::optional<DueSchedule> due_;
    std::optional<std::uint64_t> last_frame_id_; ///< in this session
    std::optional<std::int64_t> last_frame_ns_;  ///< when it was decoded
    TimePoint opens_at_;
    TimePoint opened_at_;
    TimePoint thinks_until_{};
    std::optional<TimePoint> leaves_at_;    ///< end of this stay (churn)
    std::optional<TimePoint> cut_at_;       ///< after half-closing: when to cancel if the server has not finished
    std::optional<TimePoint> present_since_; ///< since when it wants frames
    bool is_leaving_for_good_ = false;
    bool is_gone_ = false;
    ClientShare share_;
};

} // namespace fieldcast::client::load
