// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/base/rate_limit.h"
#include "server/access/gate.h"
#include "server/service/status.h"
#include "server/service/stream.h"

#include <chrono>
#include <map>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace fieldcast::service {

/// Reason for refusing a session.
struct AdmissionRefusal {
    Problem problem = Problem::kExhausted;
    std::string exceeded; ///< name of the exceeded limit, for the metrics
    std::string message;
};

/// An admitted session.
struct Admission {
    std::uint64_t id = 0;
    session::PeerBudgets budgets; ///< shared by all sessions of its peer
};

/// All open streams and the limits of their number. Thread-safe.
class SessionTable {
public:
    explicit SessionTable(const session::Limits& limits);

    /// Admits a session of `peer` with `identity`, or returns why it is refused.
    tl::expected<Admission, AdmissionRefusal> admit(const std::string& peer, const access::Identity& identity);

    /// Puts `stream` into the place `id`.
    void add(std::uint64_t id, const std::shared_ptr<Stream>& stream);
    void remove(std::uint64_t id);

    /// Refuses all further sessions; `admit` returns the reason given here.
    void close(const std::string& reason);

    std::vector<std::shared_ptr<Stream>> streams();

    /// The streams whose identity is no longer valid for `gate`.
    std::vector<std::shared_ptr<Stream>> streams_without_token(const access::Gate& gate);
    std::size_t size();

    /// Waits until there are no sessions. False: there are still some at `deadline`.
    bool wait_until_empty(session::TimePoint deadline);

private:
    struct Place {
        std::string peer;
        access::Identity identity;
        session::PeerBudgets budgets;
        std::weak_ptr<Stream> stream;
    };
    struct State {
        std::map<std::uint64_t, Place> places;
        std::map<std::string, RateLimit> opens; ///< by peer, of recent peers
        std::optional<RateLimit> all_opens;
        std::uint64_t next_id = 1;
        std::string closed_because; ///< reason; empty: not closed
    };

    std::optional<AdmissionRefusal> problem_with(State& state, const std::string& peer) const;
    /// Counts one more opening against the rate limits. The message if `peer`, or all peers together, open too fast.
    std::optional<std::string> open_rate_problem(State& state, const std::string& peer) const;
    session::PeerBudgets budgets_of(const State& state, const std::string& peer) const;

    const session::Limits limits_;
    const std::shared_ptr<session::Budget> total_bytes_;   ///< bytes in flight
    const std::shared_ptr<session::Budget> total_cameras_; ///< clients' own cameras
    std::condition_variable removed_;
    Guarded<State> state_;
};

} // namespace fieldcast::service
