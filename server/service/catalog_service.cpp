// SPDX-License-Identifier: Apache-2.0
#include "server/service/catalog_service.h"

#include "core/wire/convert.h"
#include "server/service/messages.h"
#include "server/service/status.h"

#include <algorithm>

namespace fieldcast::service {

namespace {

v1::ServerLimits limits_message(const std::vector<std::shared_ptr<feed::Feed>>& channels,
                                const session::Limits& limits) {
    v1::ServerLimits message;
    message.set_max_views(kMaxViews);
    message.set_max_view_set_pixels(limits.max_view_set_pixels);
    message.set_max_sessions(limits.max_sessions);
    message.set_max_sessions_per_peer(limits.max_sessions_per_peer);
    message.set_max_bytes_in_flight(limits.max_bytes_in_flight);
    message.set_max_chunk_bytes(limits.max_chunk_bytes);
    for (const auto& channel : channels) {
        const feed::ChannelInfo& info = channel->info();
        message.set_max_view_width_px(std::max(message.max_view_width_px(), info.source_width_px));
        message.set_max_view_height_px(std::max(message.max_view_height_px(), info.source_height_px));
        message.set_max_frames_per_second(std::max(message.max_frames_per_second(), info.frames_per_second));
    }
    return message;
}

v1::CameraControl to_proto(feed::CameraControl control) {
    switch (control) {
    case feed::CameraControl::kFixed:
        return v1::CAMERA_CONTROL_FIXED;
    case feed::CameraControl::kScripted:
        return v1::CAMERA_CONTROL_SCRIPTED;
    case feed::CameraControl::kSteered:
        return v1::CAMERA_CONTROL_STEERED;
    case feed::CameraControl::kOwn:
        return v1::CAMERA_CONTROL_OWN;
    }
    return v1::CAMERA_CONTROL_UNSPECIFIED;
}

v1::Channel channel_message(const feed::ChannelInfo& info) {
    v1::Channel message;
    message.set_name(info.name);
    message.set_scene_hash(info.scene_hash.data(), info.scene_hash.size());
    message.set_source_width_px(info.source_width_px);
    message.set_source_height_px(info.source_height_px);
    message.set_fovy_rad(info.fovy_rad);
    wire::to_proto(info.largest_grid, *message.mutable_largest_grid());
    message.set_frames_per_second(info.frames_per_second);
    v1::ChannelCamera& camera = *message.add_cameras();
    camera.set_name(info.camera);
    camera.set_control(to_proto(info.control));
    wire::to_proto(info.guard_band, *message.mutable_guard_band());
    return message;
}

class RefuseFetch final : public grpc::ServerWriteReactor<v1::SceneChunk> {
public:
    explicit RefuseFetch(const grpc::Status& status) { Finish(status); }
    void OnDone() override { delete this; }
};

} // namespace

CatalogService::CatalogService(const std::vector<std::shared_ptr<feed::Feed>>& channels, const session::Limits& limits,
                               metrics::Registry& registry)
    : channels_(channels), limits_(limits), downloads_(limits, registry) {
    server_info_.set_version(FIELDCAST_VERSION);
    server_info_.add_modes(v1::DELIVERY_MODE_VIEWS);
    server_info_.add_modes(v1::DELIVERY_MODE_SCENE);
    server_info_.add_modes(v1::DELIVERY_MODE_WARP);
    server_info_.add_codecs(v1::CODEC_ZSTD_FILTERED);
    server_info_.add_codecs(v1::CODEC_RAW);
    server_info_.add_codecs(v1::CODEC_JPEG);
    server_info_.add_codecs(v1::CODEC_H264);
    *server_info_.mutable_limits() = limits_message(channels, limits);
    for (const auto& channel : channels) {
        *channel_list_.add_channels() = channel_message(channel->info());
    }
}

grpc::ServerUnaryReactor* CatalogService::GetServerInfo(grpc::CallbackServerContext* context,
                                                        const v1::GetServerInfoRequest*,
                                                        v1::GetServerInfoResponse* response) {
    *response = server_info_;
    grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
}

grpc::ServerUnaryReactor* CatalogService::ListChannels(grpc::CallbackServerContext* context,
                                                       const v1::ListChannelsRequest*,
                                                       v1::ListChannelsResponse* response) {
    *response = channel_list_;
    grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
}

grpc::ServerWriteReactor<v1::SceneChunk>* CatalogService::FetchScene(grpc::CallbackServerContext* context,
                                                                     const v1::FetchSceneRequest* request) {
    const std::string& hash = request->scene_hash();
    const auto shows_scene = [&](const std::shared_ptr<feed::Feed>& channel) {
        const auto& own = channel->info().scene_hash;
        return channel->info().bundle != nullptr && hash.size() == own.size() &&
               std::ranges::equal(hash, own, [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
    };
    if (hash.size() != sizeof(feed::ChannelInfo::scene_hash)) {
        return new RefuseFetch(
            to_status(Problem::kInvalid, "scene_hash: " + std::to_string(hash.size()) + " bytes, a SHA-256 has 32"));
    }
    const auto channel = std::ranges::find_if(channels_, shows_scene);
    if (channel == channels_.end()) {
        return new RefuseFetch(to_status(Problem::kNotFound, "scene_hash: no channel of this server shows that scene"));
    }
    const auto& bundle = (*channel)->info().bundle;
    if (request->offset() > bundle->size()) {
        return new RefuseFetch(to_status(Problem::kOutOfRange, "offset: " + std::to_string(request->offset()) +
                                                                   " is beyond the end of the bundle, " +
                                                                   std::to_string(bundle->size()) + " bytes"));
    }
    return send(*context, bundle, request->offset());
}

grpc::ServerWriteReactor<v1::SceneChunk>* CatalogService::send(grpc::CallbackServerContext& context,
                                                               std::shared_ptr<const std::vector<std::byte>> bundle,
                                                               std::uint64_t offset) {
    const auto id = downloads_.admit(peer_host(context.peer()));
    if (!id) {
        return new RefuseFetch(to_status(Problem::kExhausted, id.error()));
    }
    const auto writer = SceneWriter::open(context, {.bundle = std::move(bundle),
                                                    .offset = offset,
                                                    .stall_deadline = limits_.stall_deadline,
                                                    .on_done = [this, id = *id](DownloadEnd end, std::uint64_t bytes) {
                                                        downloads_.remove(id, end, bytes);
                                                    }});
    downloads_.add(*id, writer);
    return writer.get();
}

} // namespace fieldcast::service
