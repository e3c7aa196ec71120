// SPDX-License-Identifier: Apache-2.0
// What callers of the HTTP edge cannot do to others, or to the end of the process: with silence, with slowness, with
// numbers.
#include "tests/server/no_descriptors.h"
#include "tests/server/web_fixture.h"

#include <atomic>
#include <condition_variable>
#include <csignal>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <thread>

namespace fieldcast::web {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using test::http_get;
using test::HttpCaller;
using test::HttpsCaller;
using testing::HasSubstr;

constexpr auto kPrompt = 1s; // far above what it takes, far below any limit
constexpr auto kLate = 15s;  // by which a busy machine may miss a limit; far below the limits that do not strike
const std::string kGet = "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n";

template <class Do> std::chrono::duration<double> time_of(Do act) {
    const auto begin = Clock::now();
    act();
    return Clock::now() - begin;
}

/// Callers over TLS that send a byte of an endless request every 1.5 s.
class Drips {
public:
    Drips(int count, int port, const std::string& authority) {
        for (int i = 0; i < count; ++i) {
            callers_.push_back(std::make_unique<HttpsCaller>("127.0.0.1", port, authority));
        }
        thread_ = std::jthread([this](const std::stop_token& stop) { drip(stop); });
    }

    bool has_sent(int bytes) {
        return state_.lock().wait_until(changed_, Clock::now() + 20s, [&](int sent) { return sent >= bytes; });
    }

private:
    void drip(const std::stop_token& stop) {
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        do {
            for (const auto& caller : callers_) {
                caller->send("G");
            }
            ++*state_.lock();
            changed_.notify_all();
        } while (!never.wait_for(lock, stop, 1500ms, [&] { return stop.stop_requested(); }));
    }

    std::vector<std::unique_ptr<HttpsCaller>> callers_;
    std::condition_variable changed_;
    Guarded<int> state_; ///< bytes that each has sent
    std::jthread thread_;
};

class SlowCallers : public test::WebFixture {
protected:
    SlowCallers() { signal(SIGPIPE, SIG_IGN); } // OpenSSL in our callers writes to connections that were cut
};

TEST_F(SlowCallers, AByteEverySecondAndAHalfOverTlsDelaysNeitherScrapesNorTheEnd) {
    auto endpoint = std::make_optional<Endpoint>(over_tls(), gate_, routes());
    Drips drips(5, endpoint->port(), authority_.certificate());
    const HttpCaller silent("127.0.0.1", endpoint->port());
    for (const int bytes : {1, 2}) {
        ASSERT_TRUE(drips.has_sent(bytes));
        std::string answer;
        EXPECT_LT(time_of([&] { answer = scrape(endpoint->port()); }), kPrompt);
        EXPECT_THAT(answer, HasSubstr("a_total 1"));
    }
    EXPECT_LT(time_of([&] { endpoint.reset(); }), kPrompt);
}

TEST_F(SlowCallers, SilentOnesAreAnsweredBeside) {
    auto endpoint = std::make_optional<Endpoint>(in_the_open("[::1]"), gate_, routes());
    const HttpCaller silent("::1", endpoint->port());
    EXPECT_LT(time_of([&] { EXPECT_THAT(http_get(endpoint->port(), kGet, "::1"), HasSubstr("a_total 1")); }), kPrompt);
    EXPECT_LT(time_of([&] { endpoint.reset(); }), kPrompt);
}

TEST_F(SlowCallers, AreCutWhenTheirTimeIsOver) {
    // `act` waits until it is cut.
    const auto expect_cut = [&](const Limits& limits, const Listening& listening, const std::string& page,
                                const std::function<void(int)>& act) {
        constexpr auto kLimit = 300ms;
        const Endpoint endpoint(listening, gate_, routes(page), limits);
        const auto time = time_of([&] { act(endpoint.port()); });
        EXPECT_GE(time, kLimit);
        EXPECT_LT(time, kLimit + kLate);
    };
    const auto say_nothing = [](int port) { EXPECT_EQ(rest_of(HttpCaller("127.0.0.1", port)), ""); };
    const auto say_half = [&](int port) {
        HttpsCaller caller("127.0.0.1", port, authority_.certificate());
        caller.send("GET /metr");
        EXPECT_EQ(caller.rest(), "");
    };
    const auto read_nothing = [](int port) {
        const HttpCaller caller("127.0.0.1", port);
        ::send(caller.descriptor(), kGet.data(), kGet.size(), MSG_NOSIGNAL);
        pollfd cut{.fd = caller.descriptor(), .events = 0, .revents = 0}; // POLLHUP or POLLERR, as both directions end
        EXPECT_EQ(::poll(&cut, 1, 20'000), 1);
    };
    const Limits patient{.exchange = 60s, .handshake = 60s, .request = 60s};
    const auto with = [&](std::chrono::milliseconds Limits::*limit) {
        Limits limits = patient;
        limits.*limit = 300ms;
        return limits;
    };
    expect_cut(with(&Limits::handshake), over_tls(), "", say_nothing);
    expect_cut(with(&Limits::request), over_tls(), "", say_half);
    expect_cut(with(&Limits::request), in_the_open(), "", say_nothing);
    expect_cut(with(&Limits::exchange), over_tls(), "", say_nothing);
    expect_cut(with(&Limits::exchange), over_tls(), "", say_half);
    expect_cut(with(&Limits::exchange), in_the_open(), std::string(16'000'000, 'x'), read_nothing);
}

TEST_F(SlowCallers, OfOneNetworkAreBounded) {
    const Limits limits{.request = 20s, .connections = {.total = 32, .per_network = 4}};
    auto endpoint = std::make_optional<Endpoint>(in_the_open(), gate_, routes(), limits);
    std::vector<std::unique_ptr<HttpCaller>> silent;
    for (int i = 0; i < 40; ++i) {
        silent.push_back(std::make_unique<HttpCaller>("127.0.0.1", endpoint->port()));
    }
    EXPECT_LT(time_of([&] { EXPECT_THAT(http_get(endpoint->port(), kGet), HasSubstr("a_total 1")); }), kPrompt);
    for (std::size_t i = 0; i < 37; ++i) {
        EXPECT_EQ(rest_of(*silent[i]), "") << "the oldest ones were cut; this waits for it";
    }
    char byte = 0;
    for (std::size_t i = 37; i < 40; ++i) {
        EXPECT_EQ(::recv(silent[i]->descriptor(), &byte, 1, MSG_DONTWAIT), -1) << "three and the scrape were four";
    }
    EXPECT_LT(time_of([&] { endpoint.reset(); }), kPrompt);
}

/// Sets how many descriptors the process may have, while it lives.
class DescriptorLimit {
public:
    explicit DescriptorLimit(rlim_t count) {
        getrlimit(RLIMIT_NOFILE, &before_);
        const rlimit now{.rlim_cur = count, .rlim_max = before_.rlim_max};
        setrlimit(RLIMIT_NOFILE, &now);
    }
    ~DescriptorLimit() { setrlimit(RLIMIT_NOFILE, &before_); }
    DescriptorLimit(const DescriptorLimit&) = delete;
    DescriptorLimit& operator=(const DescriptorLimit&) = delete;

private:
    rlimit before_{};
};

/// A caller on loopback that needs no further descriptor for connecting.
class EarlyCaller {
public:
    EarlyCaller() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
    ~EarlyCaller() { ::close(socket_); }
    EarlyCaller(const EarlyCaller&) = delete;
    EarlyCaller& operator=(const EarlyCaller&) = delete;

    void connect(int port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    }

    void ask() { EXPECT_EQ(::send(socket_, kGet.data(), kGet.size(), MSG_NOSIGNAL), std::ssize(kGet)); }

    /// Whether there is an answer within `patience`.
    bool is_answered(std::chrono::milliseconds patience) {
        pollfd answer{.fd = socket_, .events = POLLIN, .revents = 0};
        std::array<char, 4096> text{};
        return ::poll(&answer, 1, static_cast<int>(patience.count())) == 1 &&
               ::recv(socket_, text.data(), text.size(), 0) > 0;
    }

private:
    int socket_;
};

double processor_time_s() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

TEST_F(SlowCallers, AnswersWhileDescriptorsHaveRunOut) {
    if (test::kNeedsDescriptors) {
        GTEST_SKIP() << "the sanitizer needs descriptors of its own";
    }
    auto opens = routes();
    std::atomic<bool> could_open = false;
    opens[0].get = [&](const Request&) {
        const int file = ::open("/proc/self/stat", O_RDONLY | O_CLOEXEC);
        could_open = file >= 0;
        ::close(file);
        return Answer{.body = "a_total 1\n"};
    };
    const Endpoint endpoint(in_the_open(), gate_, opens);
    std::array<EarlyCaller, 10> silent; // more than one network may have
    std::array<EarlyCaller, 8> scrapes;
    const DescriptorLimit limit(64);
    std::vector<int> taken;
    for (int file = ::open("/dev/null", O_RDONLY); file >= 0; file = ::open("/dev/null", O_RDONLY)) {
        taken.push_back(file);
    }
    ASSERT_GT(taken.size(), 10U);
    for (EarlyCaller& caller : silent) {
        caller.connect(endpoint.port());
    }
    for (EarlyCaller& caller : scrapes) {
        caller.connect(endpoint.port());
        caller.ask();
        EXPECT_TRUE(caller.is_answered(kPrompt));
        EXPECT_TRUE(could_open.exchange(false)) << "there are some left for the page";
    }
    std::ranges::for_each(taken, ::close);
}

TEST_F(SlowCallers, ComesBackAfterDescriptorsHaveRunOut) {
    if (test::kNeedsDescriptors) {
        GTEST_SKIP() << "the sanitizer needs descriptors of its own";
    }
    auto endpoint = std::make_optional<Endpoint>(in_the_open(), gate_, routes());
    EarlyCaller caller;
    {
        const DescriptorLimit none(3); // nothing new can be opened, whatever is closed
        const double begin = processor_time_s();
        caller.connect(endpoint->port());
        caller.ask();
        EXPECT_FALSE(caller.is_answered(kPrompt)) << "nobody could accept";
        EXPECT_LT(processor_time_s() - begin, 0.1) << "of a second: it does not spin";
    }
    EXPECT_TRUE(caller.is_answered(kPrompt)) << "it came back by itself";
    EXPECT_LT(time_of([&] { endpoint.reset(); }), kPrompt);
}

} // namespace
} // namespace fieldcast::web
