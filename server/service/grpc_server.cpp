// SPDX-License-Identifier: Apache-2.0
#include "server/service/grpc_server.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/wire/protobuf_log.h"
#include "server/access/listening_rule.h"
#include "server/service/catalog_service.h"
#include "server/service/credentials.h"
#include "server/service/front_door.h"
#include "server/service/grpc_version.h"
#include "server/service/light_field_service.h"
#include "server/service/transport_log.h"
#include "server/service/transport_options.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace fieldcast::service {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kTickInterval{50};
constexpr milliseconds kDepartureSpread{1000};

/// One round of heartbeats and deadlines for every stream.
void tick_all(SessionTable& sessions) {
    for (const auto& stream : sessions.streams()) {
        try {
            stream->tick();
        } catch (const std::exception& problem) {
            log::error("tick failed", {{"problem", problem.what()}});
        }
    }
}

/// Checks the protection of the address again, after the configuration did: no later check would notice a gap.
void check_protection(const HostPort& address, const access::Security& security) {
    const access::Protection protection{.has_tls = security.certificates.has_value(),
                                        .has_tokens = security.tokens.has_value()};
    if (const auto problem = access::listening_problem(address.host, protection)) {
        throw UserError("--listen " + to_text(address) + ": " + *problem);
    }
    if (const auto problem = access::exposure_problem(address.host, grpc_version(), security.accepts_known_attacks)) {
        throw UserError("--listen " + to_text(address) + ": " + *problem);
    }
}

} // namespace

struct GrpcServer::State {
    State(const std::vector<std::shared_ptr<feed::Feed>>& feeds, const session::Limits& session_limits,
          const access::Security& security, const Observation& observation)
        : registry(observation.registry), channels(feeds), limits(session_limits), service_metrics(*registry),
          catalog(feeds, limits, gate, *registry), light_field(feeds, limits, gate, {&service_metrics, observation.recorder}),
          watch(security, gate, [this] { light_field.send_revoked_away(); }),
          collector(registry->on_collect([this](metrics::Page& page) { collect(page); })) {}

    void tick_until(const std::stop_token& stop);
    void look_at_channels();
    void start_draining();
    void collect(metrics::Page& page) const;

    const std::shared_ptr<metrics::Registry> registry;
    const std::vector<std::shared_ptr<feed::Feed>> channels;
    const session::Limits limits;
    ServiceMetrics service_metrics;
    access::Gate gate;
    CatalogService catalog;
    LightFieldService light_field;
    access::AccessWatch watch;
    struct Health {
        bool is_draining = false;
        bool is_serving = false;
    };
    mutable Guarded<Health> health;
    metrics::Collector collector;
    std::unique_ptr<grpc::Server> server;
    std::optional<FrontDoor> door; ///< closes before the server ends
    std::jthread ticker;
};

void GrpcServer::State::tick_until(const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
        tick_all(light_field.sessions());
        catalog.tick(Clock::now());
        look_at_channels();
        never.wait_for(lock, stop, kTickInterval, [] { return false; });
    }
}

/// Health follows what clients observe. A channel whose device hangs has not failed, but it does not serve; a port that
/// does not answer serves no new clients.
void GrpcServer::State::look_at_channels() {
    const auto now = Clock::now();
    const auto is_silent = [&](const auto& channel) { return channel->waiting_time(now) >= limits.channel_deadline; };
    const bool is_heard = door->hearing() == listener::Hearing::kHears;
    const bool has_frames = std::ranges::none_of(channels, is_silent);
    const bool serves = is_heard && has_frames;
    auto state = health.lock(); // locked during the update, too, so that draining cannot be overwritten
    if (!state->is_draining && serves != state->is_serving) {
        serves      ? log::info("serving again", {})
        : !is_heard ? log::error("not serving: the own port does not answer", {})
                    : log::error("no frames although clients wait", {{"ms", limits.channel_deadline.count()}});
        state->is_serving = serves;
        server->GetHealthCheckService()->SetServingStatus(serves); // of all services and of the empty name
    }
}

void GrpcServer::State::start_draining() {
    auto state = health.lock();
    *state = {.is_draining = true, .is_serving = false};
    server->GetHealthCheckService()->SetServingStatus(false);
}

void GrpcServer::State::collect(metrics::Page& page) const {
    page.add_gauge({"fieldcast_serving", "Health state: 1 is SERVING, 0 is NOT_SERVING."}, {},
                   health.lock()->is_serving ? 1.0 : 0.0);
    if (const auto expiry = watch.certificate_expiry()) {
        const std::chrono::duration<double> since_epoch = expiry->time_since_epoch();
        page.add_gauge({"fieldcast_certificate_expiry_timestamp_seconds",
                       "Expiry of the certificate, in seconds since 1970."},
                       {}, since_epoch.count());
    }
}

GrpcServer::GrpcServer(const HostPort& address, const std::vector<std::shared_ptr<feed::Feed>>& channels,
                       const session::Limits& limits, const access::Security& security,
                       const Observation& observation) {
    log_transport();
    wire::take_protobuf_log();
    check_protection(address, security);
    state_ = std::make_unique<State>(channels, limits, security, observation);
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    grpc::ServerBuilder builder;
    set_transport_options(builder, limits);
    state_->door.emplace(builder, make_credentials(security, state_->gate, state_->service_metrics), address, security,
                         limits);
    builder.RegisterService(&state_->catalog);
    builder.RegisterService(&state_->light_field);
    state_->server = builder.BuildAndStart();
    if (state_->server == nullptr) {
        throw std::runtime_error("gRPC failed to start");
    }
    state_->door->open(*state_->registry);
    grpc::HealthCheckServiceInterface& health = *state_->server->GetHealthCheckService();
    health.SetServingStatus(v1::Catalog::service_full_name(), true);
    health.SetServingStatus(v1::LightField::service_full_name(), true);
    state_->health.lock()->is_serving = true;
    state_->ticker = std::jthread([&state = *state_](const std::stop_token& stop) { state.tick_until(stop); });
}

GrpcServer::~GrpcServer() {
    if (state_->server != nullptr) {
        state_->ticker = {}; // it uses the door
        state_->door.reset(); // it passes connections to the server
        state_->server->Shutdown(std::chrono::system_clock::now()); // cancels all calls and waits for their OnDone
        state_->server->Wait();
    }
}

int GrpcServer::port() const {
    return state_->door->port();
}

void GrpcServer::begin_drain(const std::string& reason) {
    state_->start_draining();
    SessionTable& sessions = state_->light_field.sessions();
    sessions.close("the server is going away: " + reason);
    const auto streams = sessions.streams();
    auto at = Clock::now();
    for (const auto& stream : streams) {
        stream->go_away(reason, at);
        at += kDepartureSpread / static_cast<int>(streams.size());
    }
    log::info("draining", {{"reason", reason}, {"sessions", streams.size()}});
}

bool GrpcServer::wait_until_drained(Clock::time_point deadline) {
    return state_->light_field.sessions().wait_until_empty(deadline);
}

const access::Gate& GrpcServer::gate() const {
    return state_->gate;
}

bool GrpcServer::is_deaf() const {
    return state_->door->hearing() == listener::Hearing::kDeaf;
}

std::size_t GrpcServer::session_count() {
    return state_->light_field.sessions().size();
}

} // namespace fieldcast::service
