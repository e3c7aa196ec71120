// SPDX-License-Identifier: Apache-2.0
#include "server/service/grpc_server.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "server/access/listening_rule.h"
#include "server/service/catalog_service.h"
#include "server/service/credentials.h"
#include "server/service/light_field_service.h"
#include "server/service/transport_log.h"

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
constexpr int kMaxStreamsPerConnection = 64;

void set_transport_options(grpc::ServerBuilder& builder) {
    builder.SetMaxReceiveMessageSize(session::kMaxClientMessageBytes);
    builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0); // two servers on one port are a mistake
    builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreamsPerConnection);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 20'000);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);
}

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

void tick_until(const std::stop_token& stop, SessionTable& sessions) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
        tick_all(sessions);
        never.wait_for(lock, stop, kTickInterval, [] { return false; });
    }
}

void send_revoked_away(SessionTable& sessions, const access::Gate& gate) {
    const auto streams = sessions.streams_without_token(gate);
    for (const auto& stream : streams) {
        stream->go_away("the token of this session was revoked", Clock::now());
    }
    log::info("sessions without a token sent away", {{"count", streams.size()}});
}

/// A second look, after that at the configuration: nothing else stands between strangers and this server.
void check_protection(const HostPort& address, const access::Security& security) {
    const access::Protection protection{.has_tls = security.certificates.has_value(),
                                        .has_tokens = security.tokens.has_value()};
    if (const auto problem = access::listening_problem(address.host, protection)) {
        throw UserError("--listen " + to_text(address) + ": " + *problem);
    }
}

} // namespace

struct GrpcServer::State {
    State(std::vector<std::shared_ptr<feed::Feed>> channels, const session::Limits& limits,
          const access::Security& security)
        : catalog(channels, limits), light_field(std::move(channels), limits, gate),
          watch(security, gate, [this] { send_revoked_away(light_field.sessions(), gate); }) {}

    access::Gate gate;
    CatalogService catalog;
    LightFieldService light_field;
    access::AccessWatch watch;
    int port = 0;
    std::unique_ptr<grpc::Server> server;
    std::jthread ticker;
};

GrpcServer::GrpcServer(const HostPort& address, std::vector<std::shared_ptr<feed::Feed>> channels,
                       const session::Limits& limits, const access::Security& security) {
    log_transport();
    check_protection(address, security);
    state_ = std::make_unique<State>(std::move(channels), limits, security);
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    const std::string text = to_text(address);
    grpc::ServerBuilder builder;
    set_transport_options(builder);
    builder.AddListeningPort(text, make_credentials(security, state_->gate), &state_->port);
    builder.RegisterService(&state_->catalog);
    builder.RegisterService(&state_->light_field);
    state_->server = builder.BuildAndStart();
    if (state_->server == nullptr || state_->port == 0) {
        throw std::runtime_error("cannot listen on " + text + "; is the port in use?");
    }
    grpc::HealthCheckServiceInterface& health = *state_->server->GetHealthCheckService();
    health.SetServingStatus(v1::Catalog::service_full_name(), true);
    health.SetServingStatus(v1::LightField::service_full_name(), true);
    state_->ticker = std::jthread(
        [&sessions = state_->light_field.sessions()](const std::stop_token& stop) { tick_until(stop, sessions); });
}

GrpcServer::~GrpcServer() {
    if (state_->server != nullptr) {
        state_->server->Shutdown(std::chrono::system_clock::now()); // cancels all calls and waits for their OnDone
        state_->server->Wait();
    }
}

int GrpcServer::port() const {
    return state_->port;
}

void GrpcServer::begin_drain(const std::string& reason) {
    state_->server->GetHealthCheckService()->SetServingStatus(false);
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

std::size_t GrpcServer::session_count() {
    return state_->light_field.sessions().size();
}

} // namespace fieldcast::service
