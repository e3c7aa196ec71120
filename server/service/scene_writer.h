// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/session/limits.h"

#include "fieldcast/v1/catalog.grpc.pb.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <grpcpp/server_context.h>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace fieldcast::service {

/// How a scene download ended.
enum class DownloadEnd : std::uint8_t { kFinished, kCancelled, kStalled };
inline constexpr std::array<std::string_view, 3> kDownloadEndNames{"finished", "cancelled", "stalled"};

/// One FetchScene call: sends a bundle chunk by chunk, with one chunk in memory at a time. Lives until gRPC has called
/// OnDone and nobody else holds it.
class SceneWriter final : public grpc::ServerWriteReactor<v1::SceneChunk>,
                          public std::enable_shared_from_this<SceneWriter> {
public:
    using Clock = std::chrono::steady_clock;
    struct Setup {
        std::shared_ptr<const std::vector<std::byte>> bundle;
        std::uint64_t offset = 0;
        std::chrono::milliseconds stall_deadline{0};                          ///< for one chunk
        std::function<void(DownloadEnd end, std::uint64_t bytes_sent)> on_done; ///< called once, last
    };

    /// Starts sending.
    static std::shared_ptr<SceneWriter> open(grpc::CallbackServerContext& context, Setup setup);

    /// Cuts it if a chunk has been waiting for too long. Call it several times per deadline.
    void tick(Clock::time_point now);

    void OnWriteDone(bool ok) override;
    void OnDone() override;

private:
    struct State {
        bool is_writing = false;
        bool is_pinned = false; ///< somebody uses the context: do not finish
        bool is_over = false;
        bool is_finished = false;
        DownloadEnd end = DownloadEnd::kFinished;
        Clock::time_point write_begun;
    };

    SceneWriter(grpc::CallbackServerContext& context, Setup setup)
        : context_(context), setup_(std::move(setup)), next_(setup_.offset) {}
    void write_next();
    void finish_unless_pinned();

    grpc::CallbackServerContext& context_;
    const Setup setup_;
    std::uint64_t next_;   ///< byte; touched by gRPC's reactions only, one at a time
    v1::SceneChunk chunk_; ///< likewise
    std::uint64_t bytes_sent_ = 0;
    Guarded<State> state_;
    std::shared_ptr<SceneWriter> self_; ///< until OnDone
};

} // namespace fieldcast::service
