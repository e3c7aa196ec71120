// SPDX-License-Identifier: Apache-2.0
// The client's side of a stream, against a server that follows a script.
#include "client/net/session.h"
#include "client_fake_server.h"

#include "core/wire/convert.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace client::net;
using std::chrono_literals::operator""s;
using testing::HasSubstr;

Wish small_wish() {
    Wish wish;
    wish.rows = 1;
    wish.cols = 2;
    return wish;
}

/// A session with a fake server; every wait has a deadline.
class SessionTest : public testing::Test {
protected:
    void open(FakeServer::Script script, const Wish& wish = small_wish()) {
        server_.emplace(std::move(script));
        connection_.emplace(server_->address());
        session_.emplace(*connection_, wish, pool_);
    }

    /// The next event of that kind; others are skipped.
    template <class Kind> std::optional<Kind> next() {
        const auto deadline = std::chrono::steady_clock::now() + 10s;
        while (auto event = session_->next(deadline)) {
            if (auto* wanted = std::get_if<Kind>(&*event)) {
                return std::move(*wanted);
            }
        }
        return std::nullopt;
    }

    WorkerPool pool_{1};
    std::optional<FakeServer> server_;
    std::optional<Connection> connection_;
    std::optional<Session> session_;
};

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
        return lock.wait_until(changed, std::chrono::steady_clock::now() + 10s,
                               [&](int seen) { return seen >= count; });
    };
    Session::Options options;
    options.decoding = wire::Decoding::kChecksum;
    options.reading.on_change = [&] {
        ++*told.lock();
        changed.notify_all();
    };
    session_.emplace(*connection_, small_wish(), pool_, options);
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
    Session::Options options;
    options.reading = {.on_change = {}, .max_waiting_bytes = 1, .max_bytes_per_second = kBytesPerSecond};
    session_.emplace(*connection_, small_wish(), pool_, options);
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

TEST_F(SessionTest, ReportsARefusalWithItsField) {
    open([](FakeCall& call, int) {
        call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage message;
        message.mutable_refused()->set_request_id(1);
        message.mutable_refused()->set_field("grid.rows");
        message.mutable_refused()->set_message("9, at most\n6");
        call.send(message);
        call.read_rest();
    });
    const auto refused = next<Refused>();
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->message, "grid.rows: 9, at most 6"); // control characters do not reach the terminal
    EXPECT_FALSE(refused->is_transient);
}

TEST_F(SessionTest, EndsWhenAFrameComesBeforeConfigured) {
    open([](FakeCall& call, int) {
        const auto configure = call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage chunk;
        chunk.mutable_frame_chunk()->set_frame_id(1);
        call.send(chunk);
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("before Configured"));
    EXPECT_FALSE(ended->error.is_transient());
}

TEST_F(SessionTest, EndsWhenAnotherGridIsGranted) {
    open([](FakeCall& call, int) {
        auto configure = call.read_until(v1::ClientMessage::kConfigure);
        configure->mutable_configure()->mutable_grid()->set_cols(3);
        call.send(configured_message(configure->configure()));
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("another grid"));
}

TEST_F(SessionTest, EndsWhenALossyCodecIsGrantedThatWasNotAskedFor) {
    open([](FakeCall& call, int) {
        const auto configure = call.read_until(v1::ClientMessage::kConfigure);
        ASSERT_EQ(configure->configure().codecs_size(), 1); // of views, whose only plane is COLOUR
        v1::ServerMessage message = configured_message(configure->configure());
        v1::PlaneHeader& plane = *message.mutable_configured()->add_planes();
        plane.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
        plane.set_codec(v1::CODEC_JPEG);
        call.send(message);
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("codec that was not asked for"));
}

TEST_F(SessionTest, EndsWhenGrantedFramesAreTooLarge) {
    Wish wish = small_wish();
    wish.rows = 8;
    wish.cols = 9;
    open(
        [](FakeCall& call, int) {
            auto configure = call.read_until(v1::ClientMessage::kConfigure);
            configure->mutable_configure()->set_view_width_px(8000);
            configure->mutable_configure()->set_view_height_px(8000);
            call.send(configured_message(configure->configure()));
            call.read_rest();
        },
        wish);
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("at most 1024 MiB"));
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
    std::string address;
    {
        const FakeServer gone([](FakeCall&, int) {});
        address = gone.address();
    }
    connection_.emplace(address);
    session_.emplace(*connection_, small_wish(), pool_);
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_TRUE(ended->error.is_transient());
}

TEST(Backoff, AsksOftenWhileNobodyAnswersAndSeldomAfterThat) {
    Backoff backoff(7);
    std::chrono::milliseconds longest{0};
    std::chrono::milliseconds sum{0};
    for (int i = 0; i < Backoff::kQuickAttempts; ++i) {
        const auto wait = backoff.next(Obstacle::kUnreachable);
        longest = std::max(longest, wait);
        sum += wait;
    }
    EXPECT_LE(longest, Backoff::kLongestUnreachable);
    EXPECT_GE(sum, 30s) << "a minute, each wait shortened by up to half";
    for (int i = 0; i < 5; ++i) {
        longest = std::max(longest, backoff.next(Obstacle::kUnreachable));
    }
    EXPECT_GE(longest, Backoff::kLongest / 2) << "nobody is waited for in haste for ever";
    backoff.reset();
    EXPECT_LE(backoff.next(Obstacle::kUnreachable), Backoff::kFirst);
}

TEST(Backoff, AServerThatRefusesIsAskedSeldom) {
    Backoff backoff(7);
    std::chrono::milliseconds last{0};
    for (int i = 0; i < 8; ++i) {
        last = backoff.next(Obstacle::kRefused);
    }
    EXPECT_GE(last, Backoff::kLongest / 2);
    EXPECT_LE(backoff.next(Obstacle::kUnreachable), Backoff::kLongestUnreachable) << "it has been started again";
}

TEST(ClockSync, TrustsTheShortestRoundTrip) {
    ClockSync clock;
    EXPECT_FALSE(clock.client_from_server_ns(5));
    clock.add({0, 1000, 1000, 900}); // slow: offset −550
    clock.add({1000, 1510, 1510, 1020});
    EXPECT_EQ(clock.round_trip_ns(), 20);
    EXPECT_EQ(clock.client_from_server_ns(1510), 1010);
    EXPECT_FALSE(clock.client_from_server_ns(0)); // 0 means unknown
}

TEST(ClockSync, IgnoresExchangesThatCannotBeTrue) {
    ClockSync clock;
    clock.add({100, 10, 5, 200});            // sent before received
    clock.add({200, 10, 10, 100});           // received before sent
    clock.add({0, INT64_MAX, INT64_MAX, 1}); // would overflow
    EXPECT_FALSE(clock.round_trip_ns());
}

TEST_F(SessionTest, AsksForSomethingElseOnTheRunningStream) {
    open([](FakeCall& call, int) {
        const wire::ViewSet before = call.grant();
        call.send(views_messages(before, 1));
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        call.send(views_messages(before, 2)); // still of the old epoch
        call.send(configured_message(asked->configure()));
        call.send(
            views_messages(*wire::from_proto(configured_message(asked->configure()).configured().view_set()), 3, 2));
        call.read_rest();
    });
    ASSERT_TRUE(next<FrameArrived>());
    Wish wider = small_wish();
    wider.cols = 5;
    session_->configure(wider);
    const auto old = next<FrameArrived>();
    ASSERT_TRUE(old);
    EXPECT_EQ(std::get<wire::ReceivedViews>(old->frame.content).views.views.size(), 2U);
    const auto agreement = next<Agreement>();
    ASSERT_TRUE(agreement);
    EXPECT_EQ(agreement->epoch, 2U);
    EXPECT_EQ(agreement->view_set.grid.cols, 5U);
    const auto changed = next<FrameArrived>();
    ASSERT_TRUE(changed);
    EXPECT_EQ(changed->frame.epoch, 2U);
    EXPECT_EQ(std::get<wire::ReceivedViews>(changed->frame.content).views.views.size(), 5U);
    EXPECT_EQ(server_->call_count(), 1) << "no new connection";
}

TEST_F(SessionTest, ARefusedChangeLeavesTheAgreementAsItWas) {
    open([](FakeCall& call, int) {
        const wire::ViewSet before = call.grant();
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage no;
        no.mutable_refused()->set_request_id(asked->configure().request_id());
        no.mutable_refused()->set_reason(v1::REFUSAL_REASON_EXHAUSTED);
        call.send(no);
        call.send(views_messages(before, 7));
        call.read_rest();
    });
    ASSERT_TRUE(next<Agreement>());
    Wish wider = small_wish();
    wider.cols = 5;
    session_->configure(wider);
    const auto refused = next<Refused>();
    ASSERT_TRUE(refused);
    EXPECT_TRUE(refused->was_change);
    EXPECT_TRUE(refused->is_transient);
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived);
    EXPECT_EQ(arrived->frame_id, 7U);
}

TEST_F(SessionTest, AnEpochThatNobodyAskedForEndsTheStream) {
    open([](FakeCall& call, int) {
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        call.send(configured_message(asked->configure()));
        v1::ServerMessage another = configured_message(asked->configure());
        another.mutable_configured()->set_epoch(2);
        call.send(another);
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("nobody asked for"));
}

/// A server that grants two columns, then changes to `cols` by itself.
FakeServer::Script adapting_to(std::uint32_t cols) {
    return [cols](FakeCall& call, int) {
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        call.send(configured_message(asked->configure()));
        v1::ServerMessage changed = configured_message(asked->configure());
        changed.mutable_configured()->set_epoch(2);
        changed.mutable_configured()->mutable_view_set()->mutable_grid()->set_cols(cols);
        changed.mutable_configured()->mutable_adapted()->set_level(1);
        changed.mutable_configured()->mutable_adapted()->set_change("fewer\nviews");
        call.send(changed);
        call.send(views_messages(*wire::from_proto(changed.configured().view_set()), 3, 2));
        call.read_rest();
    };
}

TEST_F(SessionTest, FollowsAServerThatAdapts) {
    Wish wish = small_wish();
    wish.adaptation = AdaptationWish{.min_rows = 1, .min_cols = 1};
    open(adapting_to(1), wish);
    ASSERT_TRUE(next<Agreement>());
    const auto adapted = next<Agreement>();
    ASSERT_TRUE(adapted);
    ASSERT_TRUE(adapted->adapted);
    EXPECT_EQ(adapted->adapted->level, 1U);
    EXPECT_EQ(adapted->adapted->change, "fewer views") << "without control characters";
    EXPECT_EQ(adapted->view_set.grid.cols, 1U);
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived);
    EXPECT_EQ(std::get<wire::ReceivedViews>(arrived->frame.content).views.views.size(), 1U);
}

TEST_F(SessionTest, EndsWhenAServerAdaptsUnasked) {
    open(adapting_to(1));
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("adapted"));
}

TEST_F(SessionTest, EndsWhenAServerAdaptsBeyondTheBounds) {
    Wish wish = small_wish();
    wish.adaptation = AdaptationWish{.min_rows = 1, .min_cols = 1};
    open(adapting_to(3), wish); // more than was asked for
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("another grid"));
}

} // namespace
} // namespace fieldcast::test
