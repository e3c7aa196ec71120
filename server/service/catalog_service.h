// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/feed.h"
#include "server/service/download_table.h"
#include "server/session/limits.h"

#include "fieldcast/v1/catalog.grpc.pb.h"

#include <memory>
#include <string>
#include <vector>

namespace fieldcast::service {

/// What this server has. Answers are made once, when it starts; scenes are sent within limits.
class CatalogService final : public v1::Catalog::CallbackService {
public:
    /// `registry` must outlive it.
    CatalogService(const std::vector<std::shared_ptr<feed::Feed>>& channels, const session::Limits& limits,
                   metrics::Registry& registry);

    grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                            const v1::GetServerInfoRequest* request,
                                            v1::GetServerInfoResponse* response) override;
    grpc::ServerUnaryReactor* ListChannels(grpc::CallbackServerContext* context, const v1::ListChannelsRequest* request,
                                           v1::ListChannelsResponse* response) override;
    grpc::ServerWriteReactor<v1::SceneChunk>* FetchScene(grpc::CallbackServerContext* context,
                                                         const v1::FetchSceneRequest* request) override;

    /// Cuts downloads whose client does not read.
    void tick(std::chrono::steady_clock::time_point now) { downloads_.tick(now); }

private:
    grpc::ServerWriteReactor<v1::SceneChunk>* send(grpc::CallbackServerContext& context,
                                                   std::shared_ptr<const std::vector<std::byte>> bundle,
                                                   std::uint64_t offset);

    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    const session::Limits limits_;
    DownloadTable downloads_;
    v1::GetServerInfoResponse server_info_;
    v1::ListChannelsResponse channel_list_;
};

} // namespace fieldcast::service
