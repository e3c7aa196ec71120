// SPDX-License-Identifier: Apache-2.0
// What a client does with the stream of a server that follows a script.
#include "tests/client/client_session.h"
#include "tests/client/closed_port.h"

#include "core/wire/convert.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace client::net;
using std::chrono_literals::operator""s;
using testing::HasSubstr;

v1::FrameAck read_ack(FakeCall& call) {
    const auto message = call.read_until(v1::ClientMessage::kFrameAck);
    return message ? message->frame_ack() : v1::FrameAck();
}

TEST_F(SessionTest, DeliversFramesAndAcknowledgesEach) {
    Guarded<std::vector<v1::FrameAck>> acks;
    open([&](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        for (const std::uint64_t id : {1U, 2U}) {
            call.send(views_messages(set, id));
            acks.lock()->push_back(read_ack(call));
        }
        call.read_rest();
    });
    for (const std::uint64_t id : {1U, 2U}) {
        const auto arrived = next<FrameArrived>();
        ASSERT_TRUE(arrived);
        EXPECT_EQ(arrived->frame_id, id);
        const auto& views = std::get<wire::ReceivedViews>(arrived->frame.content).views.views;
        ASSERT_EQ(views.size(), 2U);
        EXPECT_EQ(views[1].image.bytes.front(), std::byte{fake_grey(id)});
        EXPECT_EQ(views[0].discards.id, 2U);
        EXPECT_LE(arrived->first_byte_ns, arrived->last_byte_ns);
        EXPECT_LE(arrived->last_byte_ns, arrived->decoded_ns);
    }
    session_->half_close();
    ASSERT_TRUE(next<Ended>());
    const auto seen = *acks.lock();
    ASSERT_EQ(seen.size(), 2U);
    EXPECT_EQ(seen[1].frame_id(), 2U);
    EXPECT_EQ(seen[1].outcome(), v1::FRAME_OUTCOME_DECODED);
    EXPECT_GT(seen[1].decoded_ns(), 0);
}

TEST_F(SessionTest, TellsWhenSomethingHasComeAndWhenItEnds) {
    open([](FakeCall& call, int) {
        call.send(views_messages(call.grant(), 1));
        call.read_rest();
    });
    Guarded<int> told;
    std::condition_variable changed;
    const auto wait_for = [&](int count) {
        auto lock = told.lock();
        return lock.wait_until(changed, std::chrono::steady_clock::now() + 60s,
                               [&](int seen) { return seen >= count; });
    };
    ClientSession::Options options;
    options.decoding = wire::Decoding::kChecksum;
    options.reading.on_change = [&] {
        ++*told.lock();
        changed.notify_all();
    };
    session_.emplace(*connection_, small_request(), pool_, options);
    ASSERT_TRUE(wait_for(1));
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived);
    const auto& views = std::get<wire::ReceivedViews>(arrived->frame.content).views.views;
    ASSERT_EQ(views.size(), 2U);
    EXPECT_TRUE(views[0].image.bytes.empty());
    EXPECT_GT(arrived->frame.payload_bytes, 0U);
    const int before = *told.lock();
    session_->half_close();
    ASSERT_TRUE(wait_for(before + 1));
    EXPECT_TRUE(next<Ended>());
}

TEST_F(SessionTest, ASlowReaderTakesItsTime) {
    open([](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        for (const std::uint64_t id : {1U, 2U, 3U}) {
            call.send(views_messages(set, id));
        }
        call.read_rest();
    });
    constexpr double kBytesPerSecond = 2000.0;
    ClientSession::Options options;
    options.reading = {.on_change = {}, .max_waiting_bytes = 1, .max_bytes_per_second = kBytesPerSecond};
    session_.emplace(*connection_, small_request(), pool_, options);
    const auto begin = std::chrono::steady_clock::now();
    std::uint64_t bytes = 0;
    for (int i = 0; i < 3; ++i) {
        const auto arrived = next<FrameArrived>();
        ASSERT_TRUE(arrived);
        bytes += arrived->frame.payload_bytes;
        EXPECT_LE(session_->next_call(), std::chrono::steady_clock::now() + 1s); // the clocks' period
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    // The trailer of the last frame is read without waiting for its own share of time; everything before it took its.
    EXPECT_GE(taken.count(), 0.9 * static_cast<double>(bytes) / kBytesPerSecond);
}

TEST_F(SessionTest, SendsASecondAcknowledgementWithTimes) {
    Guarded<std::optional<v1::FrameAck>> repeated;
    open([&](FakeCall& call, int) {
        call.send(views_messages(call.grant(), 1));
        read_ack(call);
        *repeated.lock() = read_ack(call);
        call.read_rest();
    });
    ASSERT_TRUE(next<FrameArrived>());
    FrameReport report;
    report.frame_id = 1;
    report.epoch = 1;
    report.shown_ns = 77;
    session_->report(report);
    session_->half_close();
    ASSERT_TRUE(next<Ended>());
    ASSERT_TRUE(repeated.lock()->has_value());
    EXPECT_EQ((*repeated.lock())->shown_ns(), 77);
}

TEST_F(SessionTest, ReportsADamagedFrameAndShowsTheNext) {
    Guarded<v1::FrameAck> first_ack;
    open([&](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        std::vector<v1::ServerMessage> damaged = views_messages(set, 1);
        v1::FrameTrailer& trailer = *damaged.back().mutable_frame_chunk()->mutable_trailer();
        trailer.set_crc32c(trailer.crc32c() ^ 1U);
        call.send(damaged);
        *first_ack.lock() = read_ack(call);
        call.send(views_messages(set, 2));
        call.read_rest();
    });
    ASSERT_TRUE(next<FrameFailed>());
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived);
    EXPECT_EQ(arrived->frame_id, 2U);
    EXPECT_EQ(first_ack.lock()->outcome(), v1::FRAME_OUTCOME_FAILED);
    EXPECT_EQ(first_ack.lock()->frame_id(), 1U);
}

TEST_F(SessionTest, RejectsViewsOfAnotherSizeThanAgreed) {
    open([](FakeCall& call, int) {
        wire::ViewSet set = call.grant();
        set.width_px = 32;
        call.send(views_messages(set, 1));
        call.read_rest();
    });
    const auto failed = next<FrameFailed>();
    ASSERT_TRUE(failed);
    EXPECT_THAT(failed->reason, HasSubstr("than agreed"));
}

TEST_F(SessionTest, GivesUpOnAServerThatSendsOnlyRubbish) {
    open([](FakeCall& call, int) {
        call.grant();
        for (std::uint64_t id = 1; id < 100; ++id) {
            v1::ServerMessage chunk;
            chunk.mutable_frame_chunk()->set_frame_id(id);
            chunk.mutable_frame_chunk()->set_epoch(1);
            chunk.mutable_frame_chunk()->mutable_header();
            call.send(chunk);
        }
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("undecodable"));
}

TEST_F(SessionTest, CountsAbortedFramesWithoutAcknowledgingThem) {
    Guarded<v1::FrameAck> first_ack;
    open([&](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        call.send(views_messages(set, 1).front());
        v1::ServerMessage aborted;
        aborted.mutable_frame_aborted()->set_frame_id(1);
        aborted.mutable_frame_aborted()->set_epoch(1);
        call.send(aborted);
        call.send(views_messages(set, 2));
        *first_ack.lock() = read_ack(call);
        call.read_rest();
    });
    ASSERT_TRUE(next<FrameAborted>());
    ASSERT_TRUE(next<FrameArrived>());
    session_->half_close();
    ASSERT_TRUE(next<Ended>());
    EXPECT_EQ(first_ack.lock()->frame_id(), 2U);
}

TEST_F(SessionTest, MapsServerTimesOntoItsOwnClock) {
    // The server's clock is one hour ahead; answering takes no time.
    constexpr std::int64_t kAheadNs = 3'600'000'000'000;
    open([](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        const auto request = call.read_until(v1::ClientMessage::kTimeSync);
        v1::ServerMessage answer;
        answer.mutable_time_sync()->set_client_send_ns(request->time_sync().client_send_ns());
        answer.mutable_time_sync()->set_server_receive_ns(steady_now_ns() + kAheadNs);
        answer.mutable_time_sync()->set_server_send_ns(steady_now_ns() + kAheadNs);
        call.send(answer);
        std::vector<v1::ServerMessage> frame = views_messages(set, 1);
        frame.back().mutable_frame_chunk()->mutable_trailer()->mutable_times()->set_pose_sampled_ns(steady_now_ns() +
                                                                                                    kAheadNs);
        call.send(frame);
        call.read_rest();
    });
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived && arrived->pose_sampled_ns);
    const std::int64_t error_ns = *session_->clock().round_trip_ns() / 2; // what the exchange can be off at most
    EXPECT_LE(*arrived->pose_sampled_ns, arrived->decoded_ns + error_ns);
    EXPECT_GT(*arrived->pose_sampled_ns, arrived->decoded_ns - 10'000'000'000);
}

TEST_F(SessionTest, ReportsAServerThatIsNotThere) {
    const ClosedPort nobody;
    connection_.emplace(nobody.address());
    session_.emplace(*connection_, small_request(), pool_);
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_TRUE(ended->error.is_transient());
}

} // namespace
} // namespace fieldcast::test
