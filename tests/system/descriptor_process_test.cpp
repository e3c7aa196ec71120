// SPDX-License-Identifier: Apache-2.0
// The real server when descriptors are short: it serves on when it has some again, and ends with a code of its own when
// it is deaf for good. Replays a recording, so it needs no device.
#include "tests/fixtures/http_client.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"

#include <csignal>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kPatience = 60s;
constexpr int kDeafCode = 3;
/// Three questions of 5 s, 1 s apart, and a drain of 8 s; as much again for a busy machine.
constexpr auto kDeafWithin = 2 * 26s;

/// Waits until the other side has closed; false if it does not, or says something.
bool is_closed_by_server(int socket) {
    pollfd entry{.fd = socket, .events = POLLIN, .revents = 0};
    char byte = 0;
    return ::poll(&entry, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) == 1 &&
           ::recv(socket, &byte, 1, 0) <= 0;
}

class Descriptors : public testing::Test {
protected:
    /// With a shell's `ulimit -n`, for both limits.
    void start(int max_descriptors) {
        server_.emplace("/bin/sh",
                        std::vector<std::string>{"-c", "ulimit -n \"$1\" && shift && exec \"$@\"", "sh",
                                                 std::to_string(max_descriptors), FIELDCAST_SERVER, "--replay",
                                                 "tests/data/recordings/v1.fcrec", "--listen", "127.0.0.1:0",
                                                 "--port-file", folder_ / "port", "--metrics-listen", "127.0.0.1:0",
                                                 "--metrics-port-file", folder_ / "metrics-port"},
                        folder_ / "server.log");
        ASSERT_TRUE(server_->has_said("SERVING", kPatience)) << server_->text();
        port_ = std::stoi(text_of(folder_ / "port"));
        metrics_port_ = std::stoi(text_of(folder_ / "metrics-port"));
    }

    /// What `fieldcast-server --health` says.
    std::string health() {
        Program probe(FIELDCAST_SERVER, {"--health", "127.0.0.1:" + std::to_string(port_)}, folder_ / "health.txt");
        EXPECT_TRUE(probe.exit_code(kPatience).has_value());
        return probe.text();
    }

    std::string metrics() const {
        return http_get(metrics_port_, "GET /metrics HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    }

    void allow_descriptors(rlim_t count) {
        rlimit limit{};
        ASSERT_EQ(::prlimit(server_->pid(), RLIMIT_NOFILE, nullptr, &limit), 0);
        limit.rlim_cur = count;
        ASSERT_EQ(::prlimit(server_->pid(), RLIMIT_NOFILE, &limit, nullptr), 0);
    }

    const TestFolder folder_;
    std::optional<Program> server_;
    int port_ = 0;
    int metrics_port_ = 0;
};

TEST_F(Descriptors, CallersThatTakeAllOfThemAndLeaveDoNotMakeItDeaf) {
    ASSERT_NO_FATAL_FAILURE(start(64));
    EXPECT_THAT(server_->text(), HasSubstr("few descriptors"));
    {
        std::vector<std::unique_ptr<HttpCaller>> idle;
        for (int i = 0; i < 80; ++i) {
            idle.push_back(std::make_unique<HttpCaller>("127.0.0.1", port_));
        }
        EXPECT_TRUE(is_closed_by_server(idle.back()->descriptor())) << "the last one is too much";
        EXPECT_THAT(metrics(), HasSubstr("\nfieldcast_serving 1\n")) << "there is a reserve, and it hears itself";
    }
    EXPECT_THAT(health(), HasSubstr("SERVING"));
    const std::string page = metrics();
    EXPECT_THAT(page, HasSubstr("\nfieldcast_connections_failed_total 0\n"));
    EXPECT_THAT(page, HasSubstr("\nfieldcast_self_probe_failures_total 0\n"));
    EXPECT_THAT(page, testing::Not(HasSubstr("\nfieldcast_connections_refused_total 0\n")));
    server_->send_signal(SIGTERM);
    EXPECT_EQ(server_->exit_code(kPatience), 0);
}

TEST_F(Descriptors, ServesAgainWhenItHasSomeAgain) {
    ASSERT_NO_FATAL_FAILURE(start(1024));
    allow_descriptors(3);
    ASSERT_TRUE(server_->has_said("not serving: the own port does not answer", kPatience)) << server_->text();
    allow_descriptors(1024);
    ASSERT_TRUE(server_->has_said("serving again", kPatience)) << server_->text();
    EXPECT_THAT(health(), HasSubstr("SERVING"));
    EXPECT_THAT(metrics(), HasSubstr("\nfieldcast_serving 1\n"));
}

TEST_F(Descriptors, ADeafServerEndsWithItsOwnCode) {
    ASSERT_NO_FATAL_FAILURE(start(1024));
    allow_descriptors(3);
    EXPECT_EQ(server_->exit_code(kDeafWithin), kDeafCode) << server_->text();
    EXPECT_THAT(server_->text(), HasSubstr("the port does not answer"));
}

} // namespace
} // namespace fieldcast::test
