// SPDX-License-Identifier: Apache-2.0
#include "server/service/light_field_service.h"

#include "server/service/credentials.h"
#include "server/service/messages.h"
#include "server/service/status.h"

#include <array>
#include <map>

namespace fieldcast::service {

namespace {

/// A call that ends at once with a status.
class Refuse final : public RawReactor {
public:
    explicit Refuse(const grpc::Status& status) { Finish(status); }
    void OnDone() override { delete this; }
};

/// Quota of log lines about opened and closed sessions. The metrics count all of them.
constexpr RateLimit::Rate kComingsAndGoings{.per_second = 4.0, .burst = 256.0};

feed::SteeringRight right_of(access::Role role) {
    switch (role) {
    case access::Role::kView:
        break;
    case access::Role::kSteer:
        return feed::SteeringRight::kSteer;
    case access::Role::kAdmin:
        return feed::SteeringRight::kTake;
    }
    return feed::SteeringRight::kNone;
}

/// Other clients see the name of the token or, without tokens, the number of the session.
feed::Steerer steerer_of(const access::Identity& identity, std::uint64_t session) {
    return {.name = identity.name.empty() ? "session " + std::to_string(session) : identity.name,
            .right = right_of(identity.role)};
}

void send_away_for_token(Stream& stream) {
    stream.go_away("the token of this session was revoked", std::chrono::steady_clock::now(),
                   session::CloseReason::kRevoked);
}

using SessionKey = std::array<std::string, 3>; // channel, mode, grid

} // namespace

LightFieldService::LightFieldService(std::vector<std::shared_ptr<feed::Feed>> channels, const session::Limits& limits,
                                     const access::Gate& gate, const Observers& observers)
    : channels_(std::move(channels)), limits_(limits), gate_(gate), metrics_(*observers.metrics),
      recorder_(observers.recorder), refusals_("everybody", log::Quota::kOfEverybody),
      comings_("everybody", kComingsAndGoings), sessions_(limits),
      collector_(metrics_.registry().on_collect([this](metrics::Page& page) { collect(page); })) {
    for (const auto& channel : channels_) {
        metrics_.prepare(channel->info().name);
    }
}

void LightFieldService::collect(metrics::Page& page) {
    std::map<SessionKey, std::uint64_t> sessions;
    std::map<std::string, std::array<std::uint64_t, 3>> in_flight; // frames, bytes and adapted sessions by channel
    for (const auto& channel : channels_) {
        in_flight[channel->info().name] = {};
    }
    for (const auto& stream : sessions_.streams()) {
        stream->publish_counts();
        const SessionFacts facts = stream->facts();
        ++sessions[{facts.channel, facts.mode, facts.grid}];
        if (!facts.channel.empty()) {
            in_flight[facts.channel][0] += facts.frames_in_flight;
            in_flight[facts.channel][1] += facts.bytes_in_flight;
            in_flight[facts.channel][2] += facts.is_adapted ? 1 : 0;
        }
    }
    for (const auto& [key, count] : sessions) {
        page.add_gauge({"fieldcast_sessions", "Open sessions by configuration; empty labels: not configured yet."},
                       {{"channel", key[0]}, {"mode", key[1]}, {"grid", key[2]}}, static_cast<double>(count));
    }
    for (const auto& [channel, amounts] : in_flight) {
        page.add_gauge({"fieldcast_frames_in_flight", "Frames that were started and are not acknowledged."},
                       {{"channel", channel}}, static_cast<double>(amounts[0]));
        page.add_gauge({"fieldcast_bytes_in_flight", "Bytes of frames that were started and are not acknowledged."},
                       {{"channel", channel}}, static_cast<double>(amounts[1]));
        page.add_gauge({"fieldcast_adapted_sessions", "Sessions whose stream is reduced by adaptation."},
                       {{"channel", channel}}, static_cast<double>(amounts[2]));
    }
}

RawReactor* LightFieldService::Open(grpc::CallbackServerContext* context) {
    const std::string peer = context->peer();
    const auto identity = identify(*context, gate_);
    if (!identity) { // revoked just now
        return new Refuse(to_status(Problem::kUnauthenticated, identity.error().message));
    }
    const auto admission = sessions_.admit(peer_host(peer), *identity);
    if (!admission) {
        const AdmissionRefusal& problem = admission.error();
        metrics_.count_refused(problem.exceeded);
        refusals_.write(log::Level::kWarn, "session refused", {{"peer", peer}, {"reason", problem.message}});
        return new Refuse(to_status(problem.problem, problem.message));
    }
    const std::uint64_t id = admission->id;
    metrics_.count_opened();
    comings_.write(log::Level::kInfo, "session opened", {{"session", id}, {"peer", peer}, {"token", identity->name}});
    const auto stream = Stream::open(*context, {.channels = channels_,
                                                .limits = limits_,
                                                .budgets = admission->budgets,
                                                .steerer = steerer_of(*identity, id),
                                                .metrics = &metrics_,
                                                .recorder = recorder_,
                                                .comings = &comings_,
                                                .id = id,
                                                .on_done = [this](std::uint64_t done) { sessions_.remove(done); }});
    sessions_.add(id, stream);
    if (!gate_.is_valid(*identity)) { // revoked since: send_away_revoked() ran before this session was in the table
        send_away_for_token(*stream);
    }
    return stream.get();
}

void LightFieldService::send_revoked_away() {
    const auto streams = sessions_.streams_without_token(gate_);
    for (const auto& stream : streams) {
        send_away_for_token(*stream);
    }
    log::info("sessions with revoked tokens sent away", {{"count", streams.size()}});
}

} // namespace fieldcast::service
