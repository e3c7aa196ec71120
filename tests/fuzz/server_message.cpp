// SPDX-License-Identifier: Apache-2.0
// An input is a byte for the client's request and a row of pieces, each a ServerMessage.
#include "client/net/clock_sync.h"
#include "client/net/configure.h"
#include "tests/fuzz/received_chunks.h"

#include <algorithm>

namespace fieldcast::fuzz {

namespace {

namespace net = client::net;

constexpr std::uint64_t kMaxFrameBytes = 4U << 20; ///< a client takes 1 GiB; that is only slower

/// What a client does with the messages of a server.
class Client {
public:
    explicit Client(std::uint8_t request) {
        request_.mode = (request & 1U) != 0 ? DeliveryMode::kScene : (request & 2U) != 0 ? DeliveryMode::kWarp : DeliveryMode::kViews;
        if ((request & 4U) != 0) {
            request_.adaptation.emplace();
        }
        request_.codecs = {Codec::kH264, Codec::kJpeg, Codec::kZstdFiltered,
                        Codec::kRaw};
    }

    void take(v1::ServerMessage message) {
        switch (message.message_case()) {
        case v1::ServerMessage::kConfigured:
            return configure(message.configured());
        case v1::ServerMessage::kFrameChunk:
            return add(std::move(*message.mutable_frame_chunk()));
        case v1::ServerMessage::kFrameAborted:
            return chunks_.abort(message.frame_aborted().frame_id());
        case v1::ServerMessage::kTimeSync:
            return synchronise(message.time_sync());
        case v1::ServerMessage::kRefused:
        case v1::ServerMessage::kHeartbeat:
        case v1::ServerMessage::kGoingAway:
        case v1::ServerMessage::kSteeringGranted:
        case v1::ServerMessage::kSteeringDenied:
        case v1::ServerMessage::kSteeringReleased:
        case v1::ServerMessage::MESSAGE_NOT_SET:
            return; // shown to people, or counted
        }
    }

private:
    /// The client asks for the grid that it gets, or nothing would be looked at further.
    void configure(const v1::Configured& message) {
        const v1::Grid& grid = message.view_set().grid();
        request_.rows = grid.rows();
        request_.cols = grid.cols();
        request_.anchor = grid.anchor() == v1::ANCHOR_CENTRE ? Anchor::kCentre : Anchor::kLattice;
        const auto agreement = net::from_configured(message, request_);
        if (!agreement) {
            FC_ASSERT(!agreement.error().message.empty(), "an error says what is wrong");
            return;
        }
        agreement_ = *agreement;
        wire::FrameLimits limits = agreement->limits;
        limits.max_frame_bytes = std::min(limits.max_frame_bytes, kMaxFrameBytes);
        chunks_.begin_epoch(agreement->epoch, limits);
    }

    void add(v1::FrameChunk chunk) {
        const std::int64_t begin_ns = chunk.trailer().times().render_begin_ns();
        static_cast<void>(clock_.client_from_server_ns(begin_ns));
        const auto frame = chunks_.add(std::move(chunk));
        if (!frame || !agreement_ || net::frame_problem(*frame, *agreement_)) {
            return;
        }
        if (const auto* const views = std::get_if<wire::ReceivedViews>(&frame->content)) {
            FC_ASSERT(views->views.views.size() == agreement_->view_set.grid.view_count(), "all views are there");
        }
    }

    void synchronise(const v1::TimeSyncResponse& message) {
        clock_.add({.client_send_ns = message.client_send_ns(),
                    .server_receive_ns = message.server_receive_ns(),
                    .server_send_ns = message.server_send_ns(),
                    .client_receive_ns = net::steady_now_ns()});
        FC_ASSERT(clock_.round_trip_ns().value_or(0) >= 0, "no answer before its question");
    }

    net::Request request_;
    std::optional<net::Agreement> agreement_;
    ReceivedChunks chunks_;
    net::ClockSync clock_;
};

} // namespace

void server_message(Bytes input) {
    Reader reader(input);
    Client client(reader.take_byte());
    while (!reader.is_empty()) {
        v1::ServerMessage message;
        const Bytes piece = reader.take_piece();
        if (message.ParseFromArray(piece.data(), static_cast<int>(piece.size()))) {
            client.take(std::move(message));
        }
    }
}

} // namespace fieldcast::fuzz
