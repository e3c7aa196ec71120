// SPDX-License-Identifier: Apache-2.0
#include "client/net/catalog.h"

#include "client/net/call_status.h"
#include "client/net/connection_state.h"

#include "fieldcast/v1/catalog.grpc.pb.h"

#include <algorithm>
#include <chrono>

namespace fieldcast::client::net {
namespace {

constexpr std::chrono::seconds kUnaryDeadline{5};
constexpr std::chrono::minutes kFetchDeadline{30}; // clients on slow connections resume interrupted transfers
constexpr std::size_t kMaxChannels = 256;
constexpr std::size_t kMaxNameBytes = 64;

ChannelInfo channel_info(const v1::Channel& message) {
    ChannelInfo info;
    if (message.name().size() > kMaxNameBytes || message.scene_hash().size() != info.scene_hash.size()) {
        throw NetError("ListChannels: a channel has a name over 64 bytes, or a scene hash that is not 32 bytes", false);
    }
    info.name = message.name();
    std::copy(message.scene_hash().begin(), message.scene_hash().end(), info.scene_hash.begin());
    info.source_width_px = message.source_width_px();
    info.source_height_px = message.source_height_px();
    info.fovy_rad = message.fovy_rad();
    info.frames_per_second = message.frames_per_second();
    return info;
}

/// Checks that the pieces of a bundle are in order and agree on its size.
class PieceCheck {
public:
    explicit PieceCheck(std::uint64_t offset) : next_offset_(offset) {}

    BundlePiece check(const v1::SceneChunk& chunk) {
        if (!is_first_ && chunk.total_bytes() != total_bytes_) {
            throw NetError("FetchScene: the size of the bundle changed during the transfer", false);
        }
        is_first_ = false;
        total_bytes_ = chunk.total_bytes();
        if (chunk.offset() != next_offset_ ||
            chunk.data().size() > total_bytes_ - std::min(total_bytes_, next_offset_)) {
            throw NetError("FetchScene: a piece is out of order, or beyond the end of the bundle", false);
        }
        next_offset_ += chunk.data().size();
        return {total_bytes_, std::as_bytes(std::span(chunk.data()))};
    }

    bool is_complete() const { return !is_first_ && next_offset_ == total_bytes_; }

private:
    std::uint64_t next_offset_;
    std::uint64_t total_bytes_ = 0;
    bool is_first_ = true;
};

} // namespace

std::vector<ChannelInfo> list_channels(const Connection& connection) {
    const auto stub = v1::Catalog::NewStub(connection.state().channel);
    grpc::ClientContext context;
    connection.state().prepare(context);
    context.set_deadline(std::chrono::system_clock::now() + kUnaryDeadline);
    v1::ListChannelsResponse response;
    const grpc::Status status = stub->ListChannels(&context, {}, &response);
    if (!status.ok()) {
        throw to_error("ListChannels", status);
    }
    const std::size_t count = std::min(static_cast<std::size_t>(response.channels_size()), kMaxChannels);
    if (count == 0) {
        throw NetError("ListChannels: the server has no channel", true);
    }
    std::vector<ChannelInfo> channels;
    for (std::size_t i = 0; i < count; ++i) {
        channels.push_back(channel_info(response.channels(static_cast<int>(i))));
    }
    return channels;
}

void fetch_scene(const Connection& connection, const scene::SceneHash& hash, std::uint64_t offset,
                 const std::function<void(const BundlePiece&)>& take, const std::stop_token& stop) {
    const auto stub = v1::Catalog::NewStub(connection.state().channel);
    grpc::ClientContext context;
    connection.state().prepare(context);
    context.set_deadline(std::chrono::system_clock::now() + kFetchDeadline);
    v1::FetchSceneRequest request;
    request.set_scene_hash(std::string(hash.begin(), hash.end()));
    request.set_offset(offset);
    const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
    const auto reader = stub->FetchScene(&context, request);
    PieceCheck check(offset);
    v1::SceneChunk chunk;
    try {
        while (reader->Read(&chunk)) {
            take(check.check(chunk));
        }
    } catch (...) {
        context.TryCancel();
        reader->Finish();
        throw;
    }
    const grpc::Status status = reader->Finish();
    if (!status.ok()) {
        throw to_error("FetchScene", status);
    }
    if (!check.is_complete()) {
        throw NetError("FetchScene: the bundle ended early", true);
    }
}

} // namespace fieldcast::client::net
