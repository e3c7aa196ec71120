// SPDX-License-Identifier: Apache-2.0
// The server as a process: a signal while it starts ends it, whatever it is at.
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"

#include <csignal>
#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

constexpr auto kStepPatience = 240s; // a software device under sanitizers on a busy machine
constexpr auto kStopBound = 5s;      // docs/operations.md promises it

class StartingServer : public testing::Test {
protected:
    /// Starts it with a first frame that takes minutes, and sends `signal` once it has said `words`.
    void stop_after(const std::string& words, int signal) {
        Program server(FIELDCAST_SERVER,
                       {"--scene", "scenes/atelier/atelier.gltf", "--size", "1280x720", "--spp", "4096", "--listen",
                        "127.0.0.1:0", "--port-file", folder_ / "port", "--log-format", "json"},
                       folder_ / "server.log");
        if (!server.has_said(words, kStepPatience)) {
            ASSERT_THAT(server.text(), HasSubstr("Vulkan d"));
            GTEST_SKIP() << server.text();
        }
        server.send_signal(signal);
        EXPECT_EQ(server.exit_code(kStopBound), 0) << server.text();
        EXPECT_THAT(server.text(), HasSubstr("stopped while starting"));
        EXPECT_THAT(server.text(), Not(HasSubstr("SERVING")));
        EXPECT_FALSE(std::filesystem::exists(folder_ / "port"));
    }

    const TestFolder folder_;
};

TEST_F(StartingServer, EndsWhileItReadsTheSceneAndCompilesKernels) {
    stop_after("\"event\":\"device\"", SIGTERM);
}

TEST_F(StartingServer, EndsInTheMiddleOfTheFirstFrame) {
    stop_after("guard band settled", SIGTERM);
}

TEST_F(StartingServer, EndsByInterruptToo) {
    stop_after("\"event\":\"device\"", SIGINT);
}

} // namespace
} // namespace fieldcast::test
