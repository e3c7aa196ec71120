// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/base/log_quota.h"
#include "core/timing/timing_recorder.h"
#include "server/service/service_metrics.h"
#include "server/session/server_session.h"

#include <functional>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>
#include <memory>
#include <optional>
#include <string>

namespace fieldcast::service {

using RawReactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

/// State of one session at one moment.
struct SessionFacts {
    std::string channel; ///< empty: not configured yet
    std::string mode;    ///< "views", "scene", "warp"; empty: not configured yet
    std::string grid;    ///< "4x4"; empty: not configured yet
    std::uint32_t frames_in_flight = 0;
    std::uint64_t bytes_in_flight = 0;
    bool is_adapted = false; ///< the stream is reduced by adaptation
};

/// One LightField.Open call: moves messages between gRPC and a ServerSession. At most one write and one read are in
/// flight. Reactions return at once. Lives until gRPC has called OnDone and there are no other references.
class Stream final : public RawReactor, public std::enable_shared_from_this<Stream> {
public:
    struct Setup {
        std::vector<std::shared_ptr<feed::Feed>> channels;
        session::Limits limits;
        session::PeerBudgets budgets;
        feed::Steerer steerer;                      ///< its permissions for cameras
        ServiceMetrics* metrics = nullptr;          ///< must outlive the stream
        timing::TimingRecorder* recorder = nullptr; ///< of frame timings; null: none; must outlive the stream
        log::Quota* comings = nullptr;              ///< quota of the log line about the end; must outlive the stream
        std::uint64_t id = 0;                       ///< of the session, for the log
        std::function<void(std::uint64_t)> on_done; ///< called once, last, with `id`
    };

    /// Starts reading and writing.
    static std::shared_ptr<Stream> open(grpc::CallbackServerContext& context, Setup setup);

    /// Sends heartbeats and checks deadlines. Must be called several times per heartbeat interval.
    void tick();
    void go_away(const std::string& reason, session::TimePoint at,
                 session::CloseReason why = session::CloseReason::kDrained);

    /// Adds the events since the last call to the metrics.
    void publish_counts();
    SessionFacts facts();

    void OnReadDone(bool ok) override;
    void OnWriteDone(bool ok) override;
    void OnCancel() override;
    void OnDone() override;

private:
    struct State {
        std::optional<session::ServerSession> session;
        std::optional<grpc::Status> verdict; ///< finish with this status when no write is in flight
        session::TimePoint write_begun{};
        bool is_reading = false;
        bool is_writing = false;
        bool has_input_ended = false;
        bool is_pinned = false; ///< the context is in use: do not finish
        bool is_cut = false;    ///< TryCancel was called or is being called
        bool is_finished = false;
        bool was_cancelled = false;
        std::optional<session::CloseReason> failure; ///< why the stream itself ended the session
        session::SessionCounts published;            ///< counts that the metrics already contain
    };
    /// Work for after the lock is released.
    struct Actions {
        bool read = false;
        std::optional<wire::WireChunk> write;
        std::optional<grpc::Status> finish;
    };

    Stream(grpc::CallbackServerContext& context, Setup setup) : context_(context), setup_(std::move(setup)) {}

    void begin();
    void pump();
    Actions decide(session::TimePoint now);
    bool may_read(std::size_t bytes); ///< whether a received message of this size is within the rate limit
    void end_flood();
    void receive();
    void record_timings();
    void take_frame(const feed::FramePtr& frame);
    void end(const grpc::Status& status, std::optional<session::CloseReason> why = std::nullopt);
    static session::CloseReason close_reason(const State& state);
    bool pin_if_overdue(session::TimePoint now);
    void cut();
    void log_configuration(session::ServerSession& session) const;
    void log_closed(const session::SessionCounts& counts, session::CloseReason reason) const;

    grpc::CallbackServerContext& context_;
    const Setup setup_;
    std::shared_ptr<Stream> self_; ///< set from `open` to OnDone
    grpc::ByteBuffer incoming_;    ///< belongs to the read in flight
    grpc::ByteBuffer outgoing_;    ///< belongs to the write in flight
    Guarded<State> state_;
};

} // namespace fieldcast::service
