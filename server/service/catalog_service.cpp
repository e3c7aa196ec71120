// SPDX-License-Identifier: Apache-2.0
#include "server/service/catalog_service.h"

#include "core/wire/convert.h"
#include "server/service/credentials.h"
#include "server/service/messages.h"
#include "server/service/status.h"

#include <algorithm>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <utility>

namespace fieldcast::service {

namespace {

constexpr std::size_t kSceneChunkBytes = 1U << 20;

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

grpc::ByteBuffer to_bytes(const google::protobuf::MessageLite& message) {
    const grpc::Slice slice(message.SerializeAsString());
    return {&slice, 1};
}

/// An answer of one message.
Answer once(const google::protobuf::MessageLite& message) {
    return [part = std::optional(AnswerPart{.message = to_bytes(message)})]() mutable {
        return std::exchange(part, std::nullopt);
    };
}

/// A bundle from byte `offset` on, in chunks; at its end, one chunk without data.
Answer chunks_of(std::shared_ptr<const std::vector<std::byte>> bundle, std::uint64_t offset) {
    return [bundle = std::move(bundle), next = offset, is_over = false]() mutable -> std::optional<AnswerPart> {
        if (is_over) {
            return std::nullopt;
        }
        const std::size_t count = std::min<std::size_t>(kSceneChunkBytes, bundle->size() - next);
        v1::SceneChunk chunk;
        chunk.set_total_bytes(bundle->size());
        chunk.set_offset(next);
        chunk.set_data(bundle->data() + next, count);
        next += count;
        is_over = next >= bundle->size();
        return AnswerPart{.message = to_bytes(chunk), .payload_bytes = count};
    };
}

/// The parsed request, or the status of a malformed one.
template <class Request> tl::expected<Request, grpc::Status> parse(const grpc::ByteBuffer& bytes) {
    Request request;
    grpc::ByteBuffer shared(bytes); // Deserialize empties its argument
    if (!grpc::SerializationTraits<Request>::Deserialize(&shared, &request).ok()) {
        return tl::unexpected(to_status(Problem::kInvalid, "the request is not a " + request.GetTypeName()));
    }
    return request;
}

} // namespace

CatalogService::CatalogService(const std::vector<std::shared_ptr<feed::Feed>>& channels, const session::Limits& limits,
                               const access::Gate& gate, metrics::Registry& registry)
    : channels_(channels), limits_(limits), gate_(gate), downloads_(limits, registry) {
    server_info_.set_version(FIELDCAST_VERSION);
    for (const DeliveryMode mode : kAll<DeliveryMode>) {
        server_info_.add_modes(wire::to_proto(mode));
    }
    for (const Codec codec : kAll<Codec>) {
        server_info_.add_codecs(wire::to_proto(codec));
    }
    *server_info_.mutable_limits() = limits_message(channels, limits);
    for (const auto& channel : channels) {
        *channel_list_.add_channels() = channel_message(channel->info());
    }
    const auto add_constant = [this](int index, const char* name, const google::protobuf::MessageLite& answer) {
        add_method(index, name, [this, &answer](grpc::CallbackServerContext* context) {
            return begin(
                *context, [&answer](const grpc::ByteBuffer&) { return once(answer); }, [](CallEnd, std::uint64_t) {});
        });
    };
    add_constant(0, "/fieldcast.v1.Catalog/GetServerInfo", server_info_);
    add_constant(1, "/fieldcast.v1.Catalog/ListChannels", channel_list_);
    add_method(2, "/fieldcast.v1.Catalog/FetchScene",
               [this](grpc::CallbackServerContext* context) { return begin_download(*context); });
}

void CatalogService::add_method(int index, const char* name,
                                std::function<RawReactor*(grpc::CallbackServerContext*)> open) {
    AddMethod(new grpc::internal::RpcServiceMethod(name, grpc::internal::RpcMethod::BIDI_STREAMING, nullptr));
    MarkMethodRawCallback(
        index, new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(std::move(open)));
}

RawReactor* CatalogService::begin(grpc::CallbackServerContext& context, MakeAnswer answer,
                                  std::function<void(CallEnd, std::uint64_t)> on_done) {
    const auto identity = identify(context, gate_);
    const auto call = CatalogCall::open(
        context, {.answer = std::move(answer),
                  .request_deadline = limits_.configure_deadline,
                  .stall_deadline = limits_.stall_deadline,
                  .is_admitted = [this, identity] { return identity.has_value() && gate_.is_valid(*identity); },
                  .on_done = std::move(on_done)});
    calls_.lock()->push_back(call);
    return call.get();
}

RawReactor* CatalogService::begin_download(grpc::CallbackServerContext& context) {
    const auto place = std::make_shared<std::optional<std::uint64_t>>(); // empty: refused, or without a request
    const auto answer = [this, place, peer = peer_host(context.peer())](
                            const grpc::ByteBuffer& bytes) -> tl::expected<Answer, grpc::Status> {
        const auto request = parse<v1::FetchSceneRequest>(bytes);
        if (!request) {
            return tl::unexpected(request.error());
        }
        auto bundle = bundle_for(*request);
        if (!bundle) {
            return bundle;
        }
        const auto id = downloads_.admit(peer);
        if (!id) {
            return tl::unexpected(to_status(Problem::kExhausted, id.error()));
        }
        *place = *id;
        return bundle;
    };
    return begin(context, answer, [this, place](CallEnd end, std::uint64_t bytes) {
        if (*place) {
            downloads_.remove(**place, end, bytes);
        }
    });
}

tl::expected<Answer, grpc::Status> CatalogService::bundle_for(const v1::FetchSceneRequest& request) const {
    const std::string& hash = request.scene_hash();
    const auto shows_scene = [&](const std::shared_ptr<feed::Feed>& channel) {
        const auto& own = channel->info().scene_hash;
        return channel->info().bundle != nullptr && hash.size() == own.size() &&
               std::ranges::equal(hash, own, [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
    };
    if (hash.size() != sizeof(feed::ChannelInfo::scene_hash)) {
        return tl::unexpected(
            to_status(Problem::kInvalid,
                      "scene_hash: " + std::to_string(hash.size()) + " bytes, but a SHA-256 has 32"));
    }
    const auto channel = std::ranges::find_if(channels_, shows_scene);
    if (channel == channels_.end()) {
        return tl::unexpected(to_status(Problem::kNotFound, "scene_hash: no channel of this server has this scene"));
    }
    const auto& bundle = (*channel)->info().bundle;
    if (request.offset() > bundle->size()) {
        return tl::unexpected(to_status(Problem::kOutOfRange, "offset: " + std::to_string(request.offset()) +
                                                                  " is beyond the end of the bundle, " +
                                                                  std::to_string(bundle->size()) + " bytes"));
    }
    return chunks_of(bundle, request.offset());
}

void CatalogService::tick(std::chrono::steady_clock::time_point now) {
    std::vector<std::shared_ptr<CatalogCall>> calls;
    {
        auto open = calls_.lock();
        std::erase_if(*open, [](const auto& call) { return call.expired(); });
        for (const auto& known : *open) {
            if (auto call = known.lock()) {
                calls.push_back(std::move(call));
            }
        }
    }
    for (const auto& call : calls) {
        call->tick(now);
    }
}

} // namespace fieldcast::service
