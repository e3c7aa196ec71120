// SPDX-License-Identifier: Apache-2.0
#include "server/service/session_table.h"

#include <algorithm>

namespace fieldcast::service {

namespace {

tl::unexpected<NoPlace> exhausted(std::string message) {
    return tl::unexpected(NoPlace{.problem = Problem::kExhausted, .message = std::move(message)});
}

} // namespace

tl::expected<std::uint64_t, NoPlace> SessionTable::admit(const std::string& peer, const access::Identity& identity) {
    auto state = state_.lock();
    if (!state->closed_because.empty()) {
        return tl::unexpected(NoPlace{.problem = Problem::kUnavailable, .message = state->closed_because});
    }
    if (state->places.size() >= limits_.max_sessions) {
        return exhausted("all " + std::to_string(limits_.max_sessions) + " sessions of this server are in use");
    }
    const auto of_peer = std::ranges::count_if(state->places, [&](const auto& p) { return p.second.peer == peer; });
    if (static_cast<std::uint64_t>(of_peer) >= limits_.max_sessions_per_peer) {
        return exhausted("all " + std::to_string(limits_.max_sessions_per_peer) +
                         " sessions that one peer may have are in use");
    }
    const std::uint64_t id = state->next_id++;
    state->places.emplace(id, Place{.peer = peer, .identity = identity, .stream = {}});
    return id;
}

void SessionTable::add(std::uint64_t id, const std::shared_ptr<Stream>& stream) {
    auto state = state_.lock();
    const auto place = state->places.find(id);
    if (place != state->places.end()) { // it may be over already
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
