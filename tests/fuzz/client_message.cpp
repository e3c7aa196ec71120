// SPDX-License-Identifier: Apache-2.0
// An input is a row of steps: a byte that says what happens and how much time passes, and for messages a piece. What
// the session sends goes to a client's assembler, which must accept all of it.
#include "server/session/server_session.h"
#include "tests/fuzz/received_chunks.h"
#include "tests/server/synthetic.h"

namespace fieldcast::fuzz {

namespace {

using namespace std::chrono_literals;

enum Step : std::uint8_t { kMessage, kFrame, kTick, kGoAway };
constexpr std::uint8_t kStepMask = 3;
constexpr int kMaxFrames = 4; ///< that are made; more are only slower

/// Made once: it has a bundle.
const feed::ChannelInfo& channel() {
    static const feed::ChannelInfo info = [] {
        feed::ChannelInfo small = test::synthetic_info();
        small.source_width_px = 16;
        small.source_height_px = 9;
        return small;
    }();
    return info;
}

/// A session on a synthetic channel, its client, and a clock.
class Conversation {
public:
    void step(std::uint8_t what, Reader& input) {
        now_ += (what >> 2) * 20ms;
        switch (what & kStepMask) {
        case kMessage:
            return receive(input.take_piece());
        case kFrame:
            return publish();
        case kTick:
            return session_.on_tick(now_);
        case kGoAway:
            return session_.go_away("closing", now_ + 1s);
        default:
            return;
        }
    }

    /// Writes what the session has to say.
    void drain() {
        while (const auto chunk = session_.next(now_)) {
            v1::ServerMessage message;
            FC_ASSERT(message.ParseFromString(wire::joined(*chunk)), "the session writes messages");
            deliver(std::move(message));
        }
        FC_ASSERT(session_.accepts_input(), "answers have gone");
    }

private:
    void receive(Bytes bytes) {
        v1::ClientMessage message;
        if (message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
            session_.on_message(message, now_);
        }
    }

    void publish() {
        if (frame_id_ < kMaxFrames) {
            ++frame_id_;
            feed_->publish(test::synthetic_frame(feed_->info(), feed_->demand(now_), frame_id_, pool_, 1), now_);
        }
    }

    void deliver(v1::ServerMessage message) {
        if (message.has_configured()) {
            FC_ASSERT(message.configured().epoch() == session_.epoch() || session_.epoch() > 0, "epochs begin with 1");
            client_.begin_epoch(message.configured().epoch(), {});
        } else if (message.has_frame_aborted()) {
            client_.abort(message.frame_aborted().frame_id());
        } else if (message.has_frame_chunk()) {
            client_.add(std::move(*message.mutable_frame_chunk()));
            FC_ASSERT(client_.error_count() == 0, "what a session sends is whole");
        }
    }

    session::TimePoint now_{1h};
    std::uint64_t frame_id_ = 0;
    WorkerPool pool_{1};
    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(channel());
    session::ServerSession session_{
        {feed_}, session::Limits{}, [this](const feed::FramePtr& frame) { session_.on_frame(frame, now_); }, now_};
    ReceivedChunks client_;
};

} // namespace

void client_message(Bytes input) {
    Conversation conversation;
    for (Reader reader(input); !reader.is_empty();) {
        conversation.step(reader.take_byte(), reader);
        conversation.drain();
    }
}

} // namespace fieldcast::fuzz
