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

/// Why a session was not admitted.
struct NoPlace {
    Problem problem = Problem::kExhausted;
    std::string exceeded; ///< the limit's name, for the metrics
    std::string message;
};

/// A session that was admitted.
struct Admission {
    std::uint64_t id = 0;
    session::PeerBudgets budgets; ///< shared by all sessions of its peer
};

/// All open streams, and the limits on their number. Thread-safe.
class SessionTable {
public:
    explicit SessionTable(const session::Limits& limits);

    /// A place for a session of `peer`, which is `identity`, or why there is none.
    tl::expected<Admission, NoPlace> admit(const std::string& peer, const access::Identity& identity);

    /// `stream` takes the place `id`.
    void add(std::uint64_t id, const std::shared_ptr<Stream>& stream);
    void remove(std::uint64_t id);

    /// No further sessions; `admit` says why.
    void close(const std::string& reason);

    std::vector<std::shared_ptr<Stream>> streams();

    /// Those whose identity `gate` does not know any more.
    std::vector<std::shared_ptr<Stream>> streams_without_token(const access::Gate& gate);
    std::size_t size();

    /// False: there are still sessions at `deadline`.
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
        std::map<std::string, RateLimit> opens; ///< by peer, of those that were here lately
        std::optional<RateLimit> all_opens;
        std::uint64_t next_id = 1;
        std::string closed_because; ///< empty: open
    };

    std::optional<NoPlace> problem_with(State& state, const std::string& peer) const;
    std::optional<std::string> haste(State& state, const std::string& peer) const; ///< who opens too fast
    session::PeerBudgets budgets_of(const State& state, const std::string& peer) const;

    const session::Limits limits_;
    const std::shared_ptr<session::Budget> total_bytes_;   ///< in flight
    const std::shared_ptr<session::Budget> total_cameras_; ///< of clients that have one each
    std::condition_variable removed_;
    Guarded<State> state_;
};

} // namespace fieldcast::service
