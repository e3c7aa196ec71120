// SPDX-License-Identifier: Apache-2.0
#include "client/load/metrics_page.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace fieldcast::client::load {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

/// Answers one HTTP request with `answer`.
class OnePage {
public:
    explicit OnePage(std::string answer) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        ::bind(socket_, reinterpret_cast<sockaddr*>(&address), size);
        ::listen(socket_, 1);
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        thread_ = std::jthread([this, text = std::move(answer)] { serve(text); });
    }
    ~OnePage() {
        ::shutdown(socket_, SHUT_RDWR);
        thread_.join();
        ::close(socket_);
    }
    OnePage(const OnePage&) = delete;
    OnePage& operator=(const OnePage&) = delete;

    MetricsUrl url() const { return *parse_metrics_url("http://127.0.0.1:" + std::to_string(port_) + "/metrics"); }
    const std::string& request() const { return request_; }

private:
    void serve(const std::string& answer) {
        const int peer = ::accept(socket_, nullptr, nullptr);
        if (peer < 0) {
            return;
        }
        char buffer[1024];
        const ssize_t count = ::recv(peer, buffer, sizeof buffer, 0);
        request_.assign(buffer, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        ::send(peer, answer.data(), answer.size(), MSG_NOSIGNAL);
        ::close(peer);
    }

    int socket_;
    int port_ = 0;
    std::string request_;
    std::jthread thread_;
};

TEST(MetricsUrl, IsPlainHttpOnLoopback) {
    const auto url = parse_metrics_url("http://[::1]:9464/a/b");
    ASSERT_TRUE(url);
    EXPECT_EQ(url->address, (HostPort{"[::1]", 9464}));
    EXPECT_EQ(url->path, "/a/b");
    EXPECT_EQ(parse_metrics_url("http://localhost:1")->path, "/metrics");
    EXPECT_THAT(parse_metrics_url("http://192.0.2.1:1/").error(), HasSubstr("must be this machine"));
    for (const char* const wrong : {"", "127.0.0.1:1", "https://127.0.0.1:1/", "http://127.0.0.1/",
                                    "http://127.0.0.1:0/", "http://127.0.0.1:1/a b", "http://127.0.0.1:1/\r\nX: y"}) {
        EXPECT_FALSE(parse_metrics_url(wrong)) << wrong;
    }
}

TEST(Metrics, ReadsSamplesAndNothingElse) {
    const Metrics metrics = parse_metrics("# HELP a Frames.\n# TYPE a counter\na 3\n"
                                          "b{channel=\"x y\",q=\"a\\\"} b\"} 2.5 1700000000\n\nnonsense\nc nothing\n"
                                          "d NaN\ne +Inf\n");
    EXPECT_THAT(metrics, ElementsAre(Pair("a", 3.0), Pair("b{channel=\"x y\",q=\"a\\\"} b\"}", 2.5)));
}

TEST(Metrics, AreFetched) {
    const OnePage page("HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\n\r\nframes 7\n");
    const auto metrics = fetch_metrics(page.url(), 60s);
    ASSERT_TRUE(metrics) << metrics.error();
    EXPECT_THAT(*metrics, ElementsAre(Pair("frames", 7.0)));
    EXPECT_THAT(page.request(), testing::StartsWith("GET /metrics HTTP/1.0\r\nHost: 127.0.0.1:"));
}

TEST(Metrics, SayWhyTheyCannotBeFetched) {
    const OnePage missing("HTTP/1.1 404 Not Found\r\n\r\nframes 7\n");
    EXPECT_THAT(fetch_metrics(missing.url(), 60s).error(), HasSubstr("answers 'HTTP/1.1 404 Not Found'"));
    const OnePage rubbish("hello");
    EXPECT_THAT(fetch_metrics(rubbish.url(), 60s).error(), HasSubstr("answers 'hello'"));
    const OnePage endless("HTTP/1.1 200 OK\r\n\r\n" + std::string(5U << 20, 'x'));
    EXPECT_THAT(fetch_metrics(endless.url(), 60s).error(), HasSubstr("at most 4 MiB"));
    EXPECT_THAT(fetch_metrics(*parse_metrics_url("http://127.0.0.1:1/"), 500ms).error(),
                HasSubstr("the connection failed"));
}

} // namespace
} // namespace fieldcast::client::load
