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

/// How a call of the catalogue ended.
enum class CallEnd : std::uint8_t { kFinished, kCancelled, kStalled, kRevoked };
inline constexpr std::array<std::string_view, 4> kCallEndNames{"finished", "cancelled", "stalled", "revoked"};

/// One message of an answer.
struct AnswerPart {
    grpc::ByteBuffer message;
    std::uint64_t payload_bytes = 0; ///< what counts in it
};

/// The messages of an answer, one with each call; nothing: that was the last.
using Answer = std::function<std::optional<AnswerPart>()>;

/// One call with one request and an answer of any number of messages, one in memory at a time. To gRPC it is a stream:
/// for other calls it waits for the request itself, for ever. Lives until gRPC has called OnDone and nobody else holds it.
class CatalogCall final : public RawReactor, public std::enable_shared_from_this<CatalogCall> {
public:
    using Clock = std::chrono::steady_clock;
    struct Setup {
        std::function<tl::expected<Answer, grpc::Status>(const grpc::ByteBuffer& request)> answer; ///< called once
        std::chrono::milliseconds request_deadline{0};                           ///< from the begin to the request
        std::chrono::milliseconds stall_deadline{0};                             ///< for one message
        std::function<bool()> is_admitted;                                       ///< whether its token still stands
        std::function<void(CallEnd end, std::uint64_t payload_bytes)> on_done; ///< called once, last
    };

    /// Waits for the request.
    static std::shared_ptr<CatalogCall> open(grpc::CallbackServerContext& context, Setup setup);

    /// Cuts it if the request or the client's reading takes too long, or if its token has gone. Call it several times per
    /// deadline.
    void tick(Clock::time_point now);

    void OnReadDone(bool ok) override;
    void OnWriteDone(bool ok) override;
    void OnDone() override;

private:
    enum class Step : std::uint8_t { kReading, kBetween, kWriting };
    struct State {
        Step step = Step::kReading;
        bool is_pinned = false; ///< somebody uses the context: do not finish
        bool is_over = false;
        bool is_finished = false;
        CallEnd end = CallEnd::kFinished;
        std::optional<grpc::Status> verdict; ///< how it ends, unless well
        Clock::time_point step_begun = Clock::now();
    };

    CatalogCall(grpc::CallbackServerContext& context, Setup setup) : context_(context), setup_(std::move(setup)) {}
    void write_next();
    void end(CallEnd end, std::optional<grpc::Status> verdict); ///< the first call counts
    void finish_unless_pinned();

    grpc::CallbackServerContext& context_;
    const Setup setup_;
    grpc::ByteBuffer request_; ///< this and the next two: touched by gRPC's reactions only, one at a time
    Answer answer_;
    std::optional<AnswerPart> part_;
    std::uint64_t payload_bytes_ = 0;
    Guarded<State> state_;
    std::shared_ptr<CatalogCall> self_; ///< until OnDone
};

} // namespace fieldcast::service
