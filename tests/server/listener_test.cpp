// SPDX-License-Identifier: Apache-2.0
// The accept loop and the server's question to itself, with callers and answers of the test's own.
#include "server/listener/acceptor.h"
#include "server/listener/self_probe.h"
#include "tests/fixtures/polling.h"
#include "tests/server/no_descriptors.h"

#include <cerrno>
#include <condition_variable>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fieldcast::listener {
namespace {

using namespace std::chrono_literals;
using namespace std::string_view_literals;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = 60s; // sanitizers on a busy machine
const HostPort kAnyPort{.host = "127.0.0.1", .port = 0};

/// Connections that were handed on; whoever waits is told.
class Taken {
public:
    Acceptor::Take take() {
        return [this](int, int connection) {
            state_.lock()->emplace_back(connection);
            changed_.notify_all();
        };
    }

    bool comes_to(std::size_t count) {
        return state_.lock().wait_until(changed_, Clock::now() + kPatience,
                                        [&](const auto& connections) { return connections.size() >= count; });
    }

    void close_all() { state_.lock()->clear(); }

private:
    std::condition_variable changed_;
    Guarded<std::vector<Descriptor>> state_;
};

/// A blocking connection to that port.
Descriptor call(int port) {
    SocketAddress target = addresses_of({.host = "127.0.0.1", .port = port}).front();
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    EXPECT_EQ(::connect(socket.number(), target.get(), target.size), 0);
    return socket;
}

/// Blocks until the other side has closed.
bool is_closed_by_server(const Descriptor& socket) {
    char byte = 0;
    return ::recv(socket.number(), &byte, 1, 0) <= 0;
}

/// Whoever connects gets an answer, or none, until the end of this. Takes one connection after the other.
class Answerer {
public:
    explicit Answerer(std::string answer) : answer_(std::move(answer)) {}

    void mute(bool is_mute) { is_mute_ = is_mute; }

    Acceptor::Take take() {
        return [this](int, int number) {
            Descriptor connection(number);
            if (!is_mute_) {
                EXPECT_EQ(::send(connection.number(), answer_.data(), answer_.size(), MSG_NOSIGNAL),
                          static_cast<ssize_t>(answer_.size()));
            }
            last_ = std::move(connection); // until the next one: closing would be an answer, too
        };
    }

private:
    const std::string answer_;
    std::atomic<bool> is_mute_ = false;
    Descriptor last_;
};

/// Settings, then the answer to the PING, as RFC 9113 has them.
std::string good_answer() {
    return std::string("\0\0\0\x04\0\0\0\0\0"sv) + std::string("\0\0\x08\x06\x01\0\0\0\0fc-alive"sv);
}

/// What the acceptor and the probe count has no event to wait for.
template <class Condition> bool comes_true(const Condition& condition) {
    return test::comes_true(condition, kPatience);
}

TEST(Descriptors, ConnectionsLeaveAReserve) {
    EXPECT_EQ(affordable_connections(256, 65536, 30), 256U);
    EXPECT_EQ(affordable_connections(256, 256, 30), 256U - 30 - 64);
    EXPECT_EQ(affordable_connections(256, 64, 30), 64U - 30 - 16);
    EXPECT_EQ(affordable_connections(256, 64, 63), 1U);
    EXPECT_EQ(affordable_connections(256, 0, 0), 1U);
    EXPECT_EQ(affordable_connections(1, 65536, 30), 1U);
}

TEST(Descriptors, LimitIsRaisedToWhatIsAllowed) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit low{.rlim_cur = 128, .rlim_max = before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &low), 0);
    EXPECT_EQ(raise_descriptor_limit(), before.rlim_max);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST(ListeningSockets, TwoServersDoNotShareAPort) {
    const ListeningSockets first(kAnyPort, 10s);
    EXPECT_NE(first.port(), 0);
    EXPECT_THROW(ListeningSockets({.host = "127.0.0.1", .port = first.port()}, 10s), std::runtime_error);
    EXPECT_THROW(ListeningSockets({.host = "no such host", .port = 0}, 10s), std::runtime_error);
    const ListeningSockets named({.host = "localhost", .port = 0}, 10s);
    EXPECT_NE(named.port(), 0);
}

TEST(Acceptor, ClosesWhatIsTooMuchAndTakesWhoComesWhenOthersHaveGone) {
    const ListeningSockets sockets(kAnyPort, 10s);
    Taken taken;
    const Acceptor acceptor(sockets, 2, taken.take());
    const Descriptor first = call(sockets.port());
    const Descriptor second = call(sockets.port());
    ASSERT_TRUE(taken.comes_to(2));
    EXPECT_TRUE(is_closed_by_server(call(sockets.port())));
    EXPECT_EQ(acceptor.counts().open, 2U);
    EXPECT_EQ(acceptor.counts().refused, 1U);
    taken.close_all();
    EXPECT_EQ(acceptor.counts().open, 0U);
    const Descriptor fourth = call(sockets.port());
    EXPECT_TRUE(taken.comes_to(1));
    EXPECT_EQ(acceptor.counts().accepted, 3U);
}

TEST(Acceptor, LetsTheServersOwnQuestionInWhenItIsFull) {
    const ListeningSockets sockets(kAnyPort, 10s);
    Taken taken;
    Acceptor acceptor(sockets, 1, taken.take());
    const Descriptor first = call(sockets.port());
    ASSERT_TRUE(taken.comes_to(1));
    OwnPort own_port(sockets.all().front().number(), Speech::kPlain);
    acceptor.let_in_always(own_port.local_port());
    const Wakeup wakeup;
    EXPECT_THAT(own_port.problem(wakeup, 100ms).value_or(""), HasSubstr("in time")) << "let in, and nobody answers";
    EXPECT_TRUE(taken.comes_to(2));
    EXPECT_EQ(acceptor.counts().refused, 0U);
    EXPECT_EQ(acceptor.counts().open, 1U);
    const Descriptor pretender(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const SocketAddress elsewhere = addresses_of({.host = "127.0.0.2", .port = own_port.local_port()}).front();
    ASSERT_EQ(::bind(pretender.number(), elsewhere.get(), elsewhere.size), 0);
    const SocketAddress target = SocketAddress::local_end_of(sockets.all().front().number());
    ASSERT_EQ(::connect(pretender.number(), target.get(), target.size), 0);
    EXPECT_TRUE(is_closed_by_server(pretender)) << "the port alone opens nothing";
}

TEST(Acceptor, ListensAgainWhenThereAreDescriptorsAgain) {
    if (test::kNeedsDescriptors) {
        GTEST_SKIP() << "the sanitizer needs descriptors of its own";
    }
    const ListeningSockets sockets(kAnyPort, 10s);
    Taken taken;
    const Acceptor acceptor(sockets, 8, taken.take());
    const Descriptor before = call(sockets.port());
    ASSERT_TRUE(taken.comes_to(1));
    SocketAddress target = addresses_of({.host = "127.0.0.1", .port = sockets.port()}).front();
    const Descriptor caller(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    {
        const test::NoDescriptors none;
        EXPECT_EQ(::connect(caller.number(), target.get(), target.size), 0);
        EXPECT_TRUE(comes_true([&] { return acceptor.counts().failed > 2; }));
    }
    EXPECT_TRUE(taken.comes_to(2));
}

TEST(OwnPort, IsAskedAgainAndAgainFromOneSocket) {
    const ListeningSockets sockets(kAnyPort, 10s);
    Answerer answerer(good_answer());
    const Acceptor acceptor(sockets, 8, answerer.take());
    OwnPort own_port(sockets.all().front().number(), Speech::kPlain);
    const Wakeup wakeup;
    for (int i = 0; i < 200; ++i) {
        ASSERT_EQ(own_port.problem(wakeup, kPatience), std::nullopt) << i;
    }
    EXPECT_EQ(acceptor.counts().accepted, 200U);
}

TEST(OwnPort, KnowsSilenceFromAnAnswer) {
    const ListeningSockets sockets(kAnyPort, 10s);
    Answerer answerer(std::string(64, 'x'));
    const Acceptor acceptor(sockets, 8, answerer.take());
    OwnPort own_port(sockets.all().front().number(), Speech::kPlain);
    const Wakeup wakeup;
    EXPECT_THAT(own_port.problem(wakeup, 200ms).value_or(""), HasSubstr("in time")) << "rubbish is no answer";
    answerer.mute(true);
    EXPECT_THAT(own_port.problem(wakeup, 200ms).value_or(""), HasSubstr("in time"));
}

TEST(OwnPort, KnowsRefusals) {
    auto sockets = std::make_unique<ListeningSockets>(kAnyPort, 10s);
    OwnPort own_port(sockets->all().front().number(), Speech::kPlain);
    const Wakeup wakeup;
    sockets.reset();
    EXPECT_THAT(own_port.problem(wakeup, kPatience).value_or(""), HasSubstr("refused"));
}

TEST(OwnPort, StopsWaitingWhenItsThreadHasTo) {
    const ListeningSockets sockets(kAnyPort, 10s); // nobody accepts
    OwnPort own_port(sockets.all().front().number(), Speech::kPlain);
    const Wakeup wakeup;
    wakeup.stop();
    const auto begin = Clock::now();
    EXPECT_EQ(own_port.problem(wakeup, kPatience), std::nullopt);
    EXPECT_LT(Clock::now() - begin, kPatience);
}

TEST(SelfProbe, TellsSilentFromDeafAndHearsAgain) {
    const ListeningSockets sockets(kAnyPort, 10s);
    Answerer answerer(good_answer());
    const Acceptor acceptor(sockets, 8, answerer.take());
    const SelfProbe probe(OwnPort(sockets.all().front().number(), Speech::kPlain),
                          {.interval = 1ms, .patience = 500ms, .failures_until_deaf = 3});
    ASSERT_TRUE(comes_true([&] { return acceptor.counts().accepted > 3; }));
    EXPECT_EQ(probe.hearing(), Hearing::kHears);
    answerer.mute(true);
    EXPECT_TRUE(comes_true([&] { return probe.hearing() == Hearing::kSilent; }));
    EXPECT_TRUE(comes_true([&] { return probe.hearing() == Hearing::kDeaf; }));
    EXPECT_GE(probe.failures(), 3U);
    answerer.mute(false);
    EXPECT_TRUE(comes_true([&] { return probe.hearing() == Hearing::kHears; }));
}

} // namespace
} // namespace fieldcast::listener
