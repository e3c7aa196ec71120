// SPDX-License-Identifier: Apache-2.0
#include "server/service/session_table.h"

#include <algorithm>

namespace fieldcast::service {

namespace {

using Clock = std::chrono::steady_clock;

/// Largest number of peers whose rate of opening is tracked; only a caller with very many addresses exceeds it.
constexpr std::size_t kMaxRememberedPeers = 4096;

/// The rate limit of all peers together is this multiple of the limit of one peer.
constexpr double kPeersAtOnce = 10.0;

AdmissionRefusal exhausted(std::string exceeded, std::string message) {
    return {.problem = Problem::kExhausted, .exceeded = std::move(exceeded), .message = std::move(message)};
}

} // namespace

SessionTable::SessionTable(const session::Limits& limits)
    : limits_(limits), total_bytes_(std::make_shared<session::Budget>(limits.max_bytes_in_flight_in_total)),
      total_cameras_(std::make_shared<session::Budget>(limits.max_own_cameras)) {
    state_.lock()->all_opens.emplace(RateLimit::Rate{.per_second = kPeersAtOnce * limits.max_opens_per_second_per_peer,
                                                     .burst = static_cast<double>(limits.max_sessions)});
}

tl::expected<Admission, AdmissionRefusal> SessionTable::admit(const std::string& peer,
                                                              const access::Identity& identity) {
    auto state = state_.lock();
    if (auto problem = problem_with(*state, peer)) {
        return tl::unexpected(std::move(*problem));
    }
    Admission admission{.id = state->next_id++, .budgets = budgets_of(*state, peer)};
    state->places.emplace(admission.id,
                          Place{.peer = peer, .identity = identity, .budgets = admission.budgets, .stream = {}});
    return admission;
}

std::optional<AdmissionRefusal> SessionTable::problem_with(State& state, const std::string& peer) const {
    if (!state.closed_because.empty()) {
        return AdmissionRefusal{
            .problem = Problem::kUnavailable, .exceeded = "draining", .message = state.closed_because};
    }
    if (state.places.size() >= limits_.max_sessions) {
        return exhausted("sessions",
                         "all " + std::to_string(limits_.max_sessions) + " sessions of this server are in use");
    }
    const auto of_peer = std::ranges::count_if(state.places, [&](const auto& p) { return p.second.peer == peer; });
    if (static_cast<std::uint64_t>(of_peer) >= limits_.max_sessions_per_peer) {
        return exhausted("sessions_per_peer", "all " + std::to_string(limits_.max_sessions_per_peer) +
                                                  " sessions that one peer may have are in use");
    }
    const auto kept = session::newcomers_reserve(limits_.max_sessions, limits_.max_sessions_per_peer);
    if (of_peer > 0 && state.places.size() + kept >= limits_.max_sessions) {
        return exhausted("sessions", "the last " + std::to_string(kept) + " of " +
                                         std::to_string(limits_.max_sessions) +
                                         " sessions of this server are reserved for peers without a session");
    }
    if (auto problem = open_rate_problem(state, peer)) { // last, because only openings that would be admitted count
        return exhausted("opens", std::move(*problem));
    }
    return std::nullopt;
}

std::optional<std::string> SessionTable::open_rate_problem(State& state, const std::string& peer) const {
    const std::string too_fast = " sessions too fast; try again in a few seconds";
    const auto now = Clock::now();
    if (state.opens.size() >= kMaxRememberedPeers) {
        std::erase_if(state.opens, [&](const auto& known) { return known.second.is_idle(now); });
    }
    if (state.opens.size() >= kMaxRememberedPeers && !state.opens.contains(peer)) {
        return "too many peers open" + too_fast;
    }
    const RateLimit fresh({.per_second = limits_.max_opens_per_second_per_peer,
                           .burst = static_cast<double>(limits_.max_sessions_per_peer)});
    if (!state.opens.try_emplace(peer, fresh).first->second.take(now)) {
        return "this peer opens" + too_fast; // takes nothing from the limit of all peers
    }
    return state.all_opens->take(now) ? std::nullopt : std::optional("all peers together open" + too_fast);
}

session::PeerBudgets SessionTable::budgets_of(const State& state, const std::string& peer) const {
    const auto other = std::ranges::find_if(state.places, [&](const auto& p) { return p.second.peer == peer; });
    if (other != state.places.end()) {
        return other->second.budgets;
    }
    return {.bytes = std::make_shared<session::Budget>(limits_.max_bytes_in_flight_per_peer, total_bytes_),
            .pixels = std::make_shared<session::Budget>(limits_.max_pixels_per_peer),
            .cameras = std::make_shared<session::Budget>(limits_.max_own_cameras_per_peer, total_cameras_)};
}

void SessionTable::add(std::uint64_t id, const std::shared_ptr<Stream>& stream) {
    auto state = state_.lock();
    const auto place = state->places.find(id);
    if (place != state->places.end()) { // it may have ended already
        place->second.stream = stream;
    }
}

void SessionTable::remove(std::uint64_t id) {
    state_.lock()->places.erase(id);
    removed_.notify_all();
}

void SessionTable::close(const std::string& reason) {
    state_.lock()->closed_because = reason;
}

std::vector<std::shared_ptr<Stream>> SessionTable::streams() {
    std::vector<std::shared_ptr<Stream>> streams;
    auto state = state_.lock();
    for (const auto& [id, place] : state->places) {
        if (auto stream = place.stream.lock()) {
            streams.push_back(std::move(stream));
        }
    }
    return streams;
}

std::vector<std::shared_ptr<Stream>> SessionTable::streams_without_token(const access::Gate& gate) {
    std::vector<std::shared_ptr<Stream>> streams;
    auto state = state_.lock();
    for (const auto& [id, place] : state->places) {
        auto stream = gate.is_valid(place.identity) ? nullptr : place.stream.lock();
        if (stream != nullptr) {
            streams.push_back(std::move(stream));
        }
    }
    return streams;
}

std::size_t SessionTable::size() {
    return state_.lock()->places.size();
}

bool SessionTable::wait_until_empty(session::TimePoint deadline) {
    return state_.lock().wait_until(removed_, deadline, [](const State& state) { return state.places.empty(); });
}

} // namespace fieldcast::service
