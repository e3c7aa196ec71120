// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/service/stream.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>

namespace fieldcast::service {

/// End of a call of the catalogue.
enum class CallEnd : std::uint8_t { kFinished, kCancelled, kStalled, kRevoked };
inline constexpr std::array<std::string_view, 4> kCallEndNames{"finished", "cancelled", "stalled", "revoked"};

/// One message of an answer.
struct AnswerPart {
    grpc::ByteBuffer message;
    std::uint64_t payload_bytes = 0; ///< bytes that count for the metrics
};

/// Returns the messages of an answer one by one; nothing after the last.
using Answer = std::function<std::optional<AnswerPart>()>;

/// One call with one request and an answer of any number of messages, one of them in memory at a time. It is a stream
/// to gRPC, because gRPC itself waits for the request of any other call without a limit. Lives until gRPC has called
/// OnDone and there are no other references.
class CatalogCall final : public RawReactor, public std::enable_shared_from_this<CatalogCall> {
public:
    using Clock = std::chrono::steady_clock;
    struct Setup {
        std::function<tl::expected<Answer, grpc::Status>(const grpc::ByteBuffer& request)> answer; ///< called once
        std::chrono::milliseconds request_deadline{0};                           ///< for the request
        std::chrono::milliseconds stall_deadline{0};                             ///< for one message of the answer
        std::function<bool()> is_admitted;                                       ///< whether its token is still valid
        std::function<void(CallEnd end, std::uint64_t payload_bytes)> on_done; ///< called once, last
    };

    /// Waits for the request.
    static std::shared_ptr<CatalogCall> open(grpc::CallbackServerContext& context, Setup setup);

    /// Cancels the call if the request or the client's reading exceeds its deadline, or if its token was revoked. Call
    /// it several times per deadline.
    void tick(Clock::time_point now);

    void OnReadDone(bool ok) override;
    void OnWriteDone(bool ok) override;
    void OnDone() override;

private:
    enum class Step : std::uint8_t { kReading, kBetween, kWriting };
    struct State {
        Step step = Step::kReading;
        bool is_pinned = false; ///< the context is in use: do not finish
        bool is_over = false;
        bool is_finished = false;
        CallEnd end = CallEnd::kFinished;
        std::optional<grpc::Status> verdict; ///< status of the end; empty: success
        Clock::time_point step_begun = Clock::now();
    };

    CatalogCall(grpc::CallbackServerContext& context, Setup setup) : context_(context), setup_(std::move(setup)) {}
    void write_next();
    void end(CallEnd end, std::optional<grpc::Status> verdict); ///< only the first call has an effect
    void finish_unless_pinned();

    grpc::CallbackServerContext& context_;
    const Setup setup_;
    grpc::ByteBuffer request_; ///< this and the next two are used by gRPC's reactions only, one at a time
    Answer answer_;
    std::optional<AnswerPart> part_;
    std::uint64_t payload_bytes_ = 0;
    Guarded<State> state_;
    std::shared_ptr<CatalogCall> self_; ///< until OnDone
};

} // namespace fieldcast::service
