// SPDX-License-Identifier: Apache-2.0
#include "client/play/receiver.h"

#include "client/play/frame_record.h"
#include "core/base/log.h"
#include "core/base/printable.h"
#include "core/scene/bundle.h"

#include <algorithm>
#include <exception>

namespace fieldcast::client::play {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

constexpr unsigned kDecodingThreads = 4; // more strips than this rarely wait

template <class... Handlers> struct Overloaded : Handlers... { using Handlers::operator()...; };

} // namespace

struct Receiver::SessionState {
    std::shared_ptr<net::ClientSession> session;
    Attempts* attempts = nullptr;
    std::optional<net::Agreement> agreement;
    net::Request granted; ///< the request that `agreement` answers
    std::optional<SessionEnd> end;
    std::optional<Clock::time_point> cut_at; ///< set after our half-close: the time at which we stop waiting

    void leave(std::chrono::milliseconds grace) {
        session->half_close();
        cut_at = std::min(cut_at.value_or(Clock::time_point::max()), Clock::now() + grace);
    }
};

Receiver::Receiver(const ServerOptions& server, const net::Request& request, std::optional<scene::SceneHash> scene_hash,
                   ReceiverExtras extras)
    : server_(server), request_(request), changes_(std::move(extras.changes)), scene_hash_(scene_hash),
      pilot_(extras.steering ? std::optional<Pilot>(std::move(*extras.steering)) : std::nullopt),
      recorder_(extras.recorder),
      pool_(std::min(kDecodingThreads, std::max(1U, std::thread::hardware_concurrency()))),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void Receiver::finish() {
    thread_.request_stop();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void Receiver::run(const std::stop_token& stop) {
    try {
        Attempts attempts(server_.reconnects, server_.patience);
        while (!stop.stop_requested()) {
            const SessionEnd end = run_session(stop, attempts);
            if (stop.stop_requested()) {
                break;
            }
            log::info("session ended", {{"reason", end.message}});
            if (!end.is_transient || !attempts.wait_for_next(stop, end.obstacle)) {
                *failure_.lock() = Failure{end.message, end.was_refused};
                break;
            }
        }
    } catch (const UserError& error) {
        *failure_.lock() = Failure{error.what(), true};
    } catch (const std::exception& error) {
        log::error("receiver failed", {{"reason", error.what()}});
        *failure_.lock() = Failure{error.what(), false};
    }
    mailbox_.close();
}

Receiver::SessionEnd Receiver::run_session(const std::stop_token& stop, Attempts& attempts) {
    constexpr auto kLookAtStop = 100ms;
    constexpr auto kFinishGrace = 2s;
    const net::Connection connection(server_.address, server_.access);
    SessionState state;
    state.attempts = &attempts;
    state.session = std::make_shared<net::ClientSession>(connection, request_, pool_);
    while (!state.end) {
        const auto look_at = Clock::now() + kLookAtStop;
        if (auto event = state.session->next(pilot_ ? std::min(look_at, pilot_->next_call()) : look_at)) {
            handle(std::move(*event), state);
        }
        if (pilot_) {
            pilot_->steer(*state.session, Clock::now());
        }
        ask_for_change(state);
        if (stop.stop_requested() && !state.cut_at) {
            state.leave(kFinishGrace);
        }
        if (state.cut_at && Clock::now() >= *state.cut_at) {
            break;
        }
    }
    return state.end.value_or(SessionEnd{"the server did not finish after our half-close"});
}

void Receiver::handle(net::Event event, SessionState& state) {
    std::visit(Overloaded{[&](net::Agreement& agreement) { agreed(std::move(agreement), state); },
                          [&](net::FrameArrived& frame) { arrived(std::move(frame), state); },
                          [&](net::FrameFailed& failed) {
                              ++counts_.lock()->failed;
                              log::warn("frame failed", {{"reason", failed.reason}});
                          },
                          [&](net::FrameAborted&) { ++counts_.lock()->aborted; },
                          [&](net::Refused& no) { refused(no, state); },
                          [&](net::GoingAway& going) {
                              log::info("server is going away", {{"reason", going.reason}});
                              state.leave(std::clamp<std::chrono::milliseconds>(going.deadline, 100ms, 10s));
                          },
                          [&](net::SteeringNews& news) { steered(news, state); },
                          [&](net::Ended& ended) {
                              const std::string message = ended.error.what();
                              state.end = SessionEnd{message.empty() ? "the server finished" : message,
                                                     ended.error.is_transient(), ended.error.is_denied(),
                                                     ended.error.obstacle()};
                          }},
               event);
}

void Receiver::ask_for_change(SessionState& state) {
    if (state.cut_at || state.end || !state.session->may_configure()) {
        return;
    }
    if (auto request = changes_.due(Clock::now())) {
        request_ = std::move(*request);
        state.session->configure(request_);
    }
}

/// A change that the server has no capacity for leaves the stream as it is. Any other refusal ends the session.
void Receiver::refused(const net::Refused& refused, SessionState& state) {
    if (refused.was_change && refused.is_transient) {
        log::warn("change refused", {{"reason", refused.message}});
        request_ = state.granted;
        return;
    }
    state.end = SessionEnd{"refused: " + refused.message, refused.is_transient, true};
}

void Receiver::agreed(net::Agreement agreement, SessionState& state) {
    if (scene_hash_ && agreement.scene_hash != *scene_hash_) {
        state.end = SessionEnd{"channel '" + printable(agreement.channel) + "' now shows another scene, " +
                                   scene::to_hex(agreement.scene_hash) + "; start the client again",
                               false};
        return;
    }
    changes_.agreed(Clock::now());
    if (agreement.adapted) {
        ++counts_.lock()->adaptations;
        log::info("server adapted", {{"epoch", agreement.epoch},
                                     {"level", agreement.adapted->level},
                                     {"change", agreement.adapted->change},
                                     {"queue_delay_ms", agreement.adapted->queue_delay_ms},
                                     {"delivered_bytes_per_second", agreement.adapted->delivered_bytes_per_second}});
        state.agreement = std::move(agreement);
        return;
    }
    state.granted = agreement.request;
    if (state.agreement) {
        ++counts_.lock()->changes;
        log::info("configuration changed", {{"epoch", agreement.epoch}});
    } else {
        ++counts_.lock()->sessions;
        log::info("session opened", {{"channel", agreement.channel}, {"epoch", agreement.epoch}});
    }
    const bool is_first = !state.agreement;
    state.agreement = std::move(agreement);
    if (pilot_ && is_first) {
        pilot_->begin(*state.session);
    }
}

void Receiver::steered(const net::SteeringNews& news, SessionState& state) {
    if (!pilot_) {
        return; // we did not request the camera
    }
    if (auto problem = pilot_->handle(*state.session, news, Clock::now())) {
        state.end = SessionEnd{std::move(*problem), false, true};
    }
}

void Receiver::arrived(net::FrameArrived frame, SessionState& state) {
    state.attempts->succeeded();
    changes_.frame_arrived();
    log::debug("frame arrived", {{"frame", frame.frame_id}, {"bytes", frame.frame.payload_bytes}});
    const auto chosen_ns = pilot_ ? pilot_->chosen_ns(frame.frame.header()) : std::nullopt;
    Arrival arrival{.agreement = *state.agreement,
                    .arrived = std::move(frame),
                    .session = state.session,
                    .pose_chosen_ns = chosen_ns,
                    .session_number = counts_.lock()->sessions};
    if (recorder_ != nullptr) {
        arrival.record = frame_record(arrival.arrived, arrival.agreement.channel, arrival.session_number);
    }
    if (auto replaced = mailbox_.put(std::move(arrival))) {
        ++counts_.lock()->superseded;
        report_times(*replaced, true, 0, 0);
        if (replaced->record) {
            replaced->record->outcome = timing::Outcome::kSuperseded;
            add_record(*recorder_, std::move(*replaced->record));
        }
    }
}

} // namespace fieldcast::client::play
