// SPDX-License-Identifier: Apache-2.0
#include "server/service/front_door.h"

#include "core/base/log.h"

namespace fieldcast::service {

namespace {

listener::Speech speech_of(const access::Security& security) {
    if (!security.certificates) {
        return listener::Speech::kPlain;
    }
    return security.certificates->client_ca ? listener::Speech::kTlsForKnownClients : listener::Speech::kTls;
}

} // namespace

FrontDoor::FrontDoor(grpc::ServerBuilder& builder, std::shared_ptr<grpc::ServerCredentials> credentials,
                     const HostPort& address, const access::Security& security, const session::Limits& limits)
    : sockets_(address, limits.keepalive_timeout), speech_(speech_of(security)), limits_(limits) {
    using From = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
    handover_ = builder.experimental().AddExternalConnectionAcceptor(From::FROM_FD, std::move(credentials));
}

void FrontDoor::open(metrics::Registry& registry) {
    listener::OwnPort own_port(sockets_.all().front().number(), speech_);
    const std::size_t most = listener::affordable_connections(limits_.max_connections, listener::descriptor_limit(),
                                                              listener::open_descriptors());
    if (most < limits_.max_connections) {
        log::warn("few descriptors", {{"limit", listener::descriptor_limit()}, {"max_connections", most}});
    }
    acceptor_.emplace(sockets_, most, [this](int listening, int connection) {
        grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters handed;
        handed.listener_fd = listening;
        handed.fd = connection;
        handover_->HandleNewConnection(&handed);
    });
    acceptor_->let_in_always(own_port.local_port());
    probe_.emplace(std::move(own_port), listener::ProbePace{.interval = limits_.probe_interval,
                                                            .patience = limits_.probe_patience,
                                                            .failures_until_deaf = limits_.probe_failures_until_deaf});
    collector_ = registry.on_collect([this](metrics::Page& page) { collect(page); });
}

listener::Hearing FrontDoor::hearing() const {
    return probe_ ? probe_->hearing() : listener::Hearing::kSilent;
}

void FrontDoor::collect(metrics::Page& page) const {
    const listener::Acceptor::Counts counts = acceptor_->counts();
    page.add_gauge({"fieldcast_connections", "Open connections of clients."}, {},
                   static_cast<double>(counts.open));
    page.add_counter({"fieldcast_connections_accepted_total", "Accepted connections."}, {},
                     static_cast<double>(counts.accepted));
    page.add_counter(
        {"fieldcast_connections_refused_total", "Connections closed at once because the limit was reached."}, {},
        static_cast<double>(counts.refused));
    page.add_counter({"fieldcast_connections_failed_total",
                      "Connections not accepted for lack of descriptors or memory."},
                     {}, static_cast<double>(counts.failed));
    page.add_counter({"fieldcast_self_probe_answers_total", "Probes of the own port with an answer."}, {},
                     static_cast<double>(probe_->answers()));
    page.add_counter(
        {"fieldcast_self_probe_failures_total", "Probes of the own port without an answer."}, {},
        static_cast<double>(probe_->failures()));
}

} // namespace fieldcast::service
