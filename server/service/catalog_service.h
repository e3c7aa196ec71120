// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/feed.h"
#include "server/session/limits.h"

#include "fieldcast/v1/catalog.grpc.pb.h"

#include <memory>
#include <string>
#include <vector>

namespace fieldcast::service {

/// What this server has. Answers are made once, when it starts.
class CatalogService final : public v1::Catalog::CallbackService {
public:
    CatalogService(const std::vector<std::shared_ptr<feed::Feed>>& channels, const session::Limits& limits);

    grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                            const v1::GetServerInfoRequest* request,
                                            v1::GetServerInfoResponse* response) override;
    grpc::ServerUnaryReactor* ListChannels(grpc::CallbackServerContext* context, const v1::ListChannelsRequest* request,
                                           v1::ListChannelsResponse* response) override;
    grpc::ServerWriteReactor<v1::SceneChunk>* FetchScene(grpc::CallbackServerContext* context,
                                                         const v1::FetchSceneRequest* request) override;

private:
    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    v1::GetServerInfoResponse server_info_;
    v1::ListChannelsResponse channel_list_;
};

} // namespace fieldcast::service
