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

/// What this server has: v1::Catalog. Answers are made once, when it starts; scenes are sent within limits. Calls whose
/// request does not come are cut.
class CatalogService final : public grpc::Service {
public:
    /// `gate` and `registry` must outlive it.
    CatalogService(const std::vector<std::shared_ptr<feed::Feed>>& channels, const session::Limits& limits,
                   const access::Gate& gate, metrics::Registry& registry);

    /// Cuts calls that do not go on, or whose token has gone.
    void tick(std::chrono::steady_clock::time_point now);

private:
    using MakeAnswer = std::function<tl::expected<Answer, grpc::Status>(const grpc::ByteBuffer& request)>;

    /// `open` begins each call of that method.
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
