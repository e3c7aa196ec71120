// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/gate.h"
#include "server/feed/feed.h"
#include "server/service/catalog_call.h"
#include "server/service/download_table.h"
#include "server/session/limits.h"

#include "fieldcast/v1/catalog.grpc.pb.h"

#include <grpcpp/impl/codegen/service_type.h>
#include <memory>
#include <string>
#include <vector>

namespace fieldcast::service {

/// v1::Catalog: the server, its channels and its scenes. Answers are built once at the start; downloads of scenes are
/// limited. Calls without a request are cancelled after a deadline.
class CatalogService final : public grpc::Service {
public:
    /// `gate` and `registry` must outlive it.
    CatalogService(const std::vector<std::shared_ptr<feed::Feed>>& channels, const session::Limits& limits,
                   const access::Gate& gate, metrics::Registry& registry);

    /// Cancels calls that exceed a deadline or whose token was revoked.
    void tick(std::chrono::steady_clock::time_point now);

private:
    using MakeAnswer = std::function<tl::expected<Answer, grpc::Status>(const grpc::ByteBuffer& request)>;

    /// Registers a method; `open` begins each of its calls.
    void add_method(int index, const char* name, std::function<RawReactor*(grpc::CallbackServerContext*)> open);
    RawReactor* begin(grpc::CallbackServerContext& context, MakeAnswer answer,
                      std::function<void(CallEnd, std::uint64_t)> on_done);
    RawReactor* begin_download(grpc::CallbackServerContext& context);
    tl::expected<Answer, grpc::Status> bundle_for(const v1::FetchSceneRequest& request) const;

    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    const session::Limits limits_;
    const access::Gate& gate_;
    DownloadTable downloads_;
    Guarded<std::vector<std::weak_ptr<CatalogCall>>> calls_;
    v1::GetServerInfoResponse server_info_;
    v1::ListChannelsResponse channel_list_;
};

} // namespace fieldcast::service
