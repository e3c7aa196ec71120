// SPDX-License-Identifier: Apache-2.0
#include "tests/client/fake_server.h"

#include "core/wire/chunks.h"
#include "core/wire/convert.h"

#include <stdexcept>

namespace fieldcast::test {
namespace {

v1::ServerMessage parsed(const wire::WireChunk& chunk) {
    v1::ServerMessage message;
    if (!message.ParseFromString(wire::joined(chunk))) {
        throw std::logic_error("a chunk of our own does not parse");
    }
    return message;
}

Views grey_views(const wire::ViewSet& set, std::uint64_t frame_id) {
    Views views;
    views.header.frame_id = frame_id;
    views.header.source = make_camera(glm::mat4(1.0F), set.fovy_rad, set.width_px, set.height_px);
    for (const LatticePosition position : lattice_positions(set.grid)) {
        Plane image{PlaneSemantic::kColour, PlaneFormat::kRgb8, set.width_px, set.height_px, {}};
        image.bytes.assign(plane_bytes(image.format, set.width_px, set.height_px), std::byte{fake_grey(frame_id)});
        views.views.push_back({position, std::move(image), DiscardCounts{.out_of_frustum = 1, .id = 2}});
    }
    return views;
}

} // namespace

std::uint8_t fake_grey(std::uint64_t frame_id) {
    return static_cast<std::uint8_t>(frame_id * 10);
}

std::optional<v1::ClientMessage> FakeCall::read_until(v1::ClientMessage::MessageCase kind) {
    v1::ClientMessage message;
    while (stream_.Read(&message)) {
        if (message.message_case() == kind) {
            return message;
        }
    }
    return std::nullopt;
}

void FakeCall::send(const std::vector<v1::ServerMessage>& messages) {
    for (const v1::ServerMessage& message : messages) {
        send(message);
    }
}

void FakeCall::read_rest() {
    v1::ClientMessage message;
    while (stream_.Read(&message)) {
    }
}

wire::ViewSet FakeCall::grant() {
    const auto configure = read_until(v1::ClientMessage::kConfigure);
    if (!configure) {
        throw std::logic_error("the client did not configure");
    }
    const v1::ServerMessage answer = configured_message(configure->configure());
    send(answer);
    return *wire::from_proto(answer.configured().view_set());
}

FakeServer::FakeServer(Script script) : script_(std::move(script)) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
}

FakeServer::~FakeServer() {
    server_->Shutdown(std::chrono::system_clock::now());
}

grpc::Status FakeServer::Open(grpc::ServerContext* /*context*/, FakeCall::Stream* stream) {
    FakeCall call(*stream);
    script_(call, calls_++);
    return grpc::Status::OK;
}

v1::ServerMessage configured_message(const v1::Configure& configure) {
    v1::ServerMessage message;
    v1::Configured& configured = *message.mutable_configured();
    configured.set_request_id(configure.request_id());
    configured.set_epoch(configure.request_id());
    configured.set_channel("fake");
    configured.set_scene_hash(std::string(32, '\xAB'));
    configured.set_mode(configure.modes(0));
    wire::ViewSet set;
    set.grid = *wire::from_proto(configure.grid(), LatticeGeometry{});
    set.width_px = configure.view_width_px() == 0 ? 64 : configure.view_width_px();
    set.height_px = configure.view_height_px() == 0 ? 36 : configure.view_height_px();
    set.fovy_rad = 0.8F;
    wire::to_proto(set, *configured.mutable_view_set());
    return message;
}

std::vector<v1::ServerMessage> views_messages(const wire::ViewSet& set, std::uint64_t frame_id, std::uint32_t epoch) {
    WorkerPool pool(1);
    wire::ViewFormat format;
    format.geometry = set.grid.geometry;
    format.fovy_rad = set.fovy_rad;
    format.width_px = set.width_px;
    format.height_px = set.height_px;
    const wire::EncodedViews encoded = wire::encode_views(grey_views(set, frame_id), format, {}, pool);
    const wire::WireFrame frame = wire::view_chunks(encoded, set.grid, {.epoch = epoch});
    std::vector<v1::ServerMessage> messages;
    for (const wire::WireChunk& chunk : frame.chunks) {
        messages.push_back(parsed(chunk));
    }
    messages.push_back(parsed(wire::trailer_chunk(frame, {})));
    return messages;
}

} // namespace fieldcast::test
