// SPDX-License-Identifier: Apache-2.0
#include "server/service/service_metrics.h"

#include "core/lightfield/vocabulary.h"

#include <array>

namespace fieldcast::service {

namespace {

constexpr std::array kDenialNames{"no_token", "unknown_token", "role_too_low"};
constexpr std::array kRefusalNames{"sessions", "sessions_per_peer", "opens", "draining"};

metrics::Counter& closed_counter(metrics::Registry& registry, session::CloseReason reason) {
    return registry.counter({"fieldcast_sessions_closed_total", "Ended sessions, by reason."},
                            {{"reason", std::string(to_text(reason))}});
}

metrics::Counter& refused_counter(metrics::Registry& registry, const std::string& reason) {
    return registry.counter(
        {"fieldcast_sessions_refused_total", "Refused sessions, by exceeded limit."},
        {{"reason", reason}});
}

metrics::Counter& denied_counter(metrics::Registry& registry, access::Denial::Kind kind) {
    return registry.counter({"fieldcast_calls_denied_total", "Calls denied for lack of a sufficient token, by reason."},
                            {{"reason", kDenialNames.at(static_cast<std::size_t>(kind))}});
}

} // namespace

ServiceMetrics::ServiceMetrics(metrics::Registry& registry)
    : registry_(registry),
      opened_(registry.counter({"fieldcast_sessions_opened_total", "Admitted sessions."}, {})) {
    for (std::size_t i = 0; i < session::kCloseReasonCount; ++i) {
        closed_counter(registry_, static_cast<session::CloseReason>(i));
    }
    for (const char* const reason : kRefusalNames) {
        refused_counter(registry_, reason);
    }
    for (std::size_t i = 0; i < kDenialNames.size(); ++i) {
        denied_counter(registry_, static_cast<access::Denial::Kind>(i));
    }
}

void ServiceMetrics::count_denied(access::Denial::Kind kind) {
    denied_counter(registry_, kind).add();
}

void ServiceMetrics::count_refused(const std::string& reason) {
    refused_counter(registry_, reason).add();
}

void ServiceMetrics::count_closed(session::CloseReason reason) {
    closed_counter(registry_, reason).add();
}

void ServiceMetrics::prepare(const std::string& channel) {
    add(channel, {});
}

void ServiceMetrics::add(const std::string& channel, const session::SessionCounts& counts) {
    const metrics::Labels of_channel{{"channel", channel}};
    const auto add = [&](const char* name, const char* help, const metrics::Labels& labels, std::uint64_t count) {
        registry_.counter({name, help}, labels).add(count);
    };
    add("fieldcast_frames_sent_total", "Completely sent frames.", of_channel, counts.frames_sent);
    add("fieldcast_frames_failed_total", "Frames that a client could not decode.", of_channel, counts.frames_failed);
    add("fieldcast_sent_bytes_total", "Sent bytes of frames, headers and aborted frames included.", of_channel,
        counts.bytes_sent);
    add("fieldcast_configurations_refused_total", "Refused Configure messages.", of_channel, counts.refusals);
    for (const auto& [direction, count] :
         {std::pair("down", counts.adaptations.down), std::pair("up", counts.adaptations.up)}) {
        add("fieldcast_adaptations_total", "Configurations that the server adapted to a connection, by direction.",
            {{"channel", channel}, {"direction", direction}}, count);
    }
    for (std::size_t i = 0; i < session::kDropReasonCount; ++i) {
        add("fieldcast_frames_dropped_total", "Frames that were not sent to a client, by reason.",
            {{"channel", channel}, {"reason", std::string(session::kDropReasonNames.at(i))}},
            counts.drops.of(static_cast<session::DropReason>(i)));
    }
    for (const auto& [choice, bytes] : counts.plane_bytes) {
        add("fieldcast_plane_bytes_total", "Payload of complete frames, by plane and codec.",
            {{"channel", channel},
             {"plane", std::string(word_of(choice.semantic))},
             {"codec", std::string(word_of(choice.encoding.codec))}},
            bytes);
    }
}

} // namespace fieldcast::service
