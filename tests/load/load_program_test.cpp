// SPDX-License-Identifier: Apache-2.0
// The program as people and pipelines call it.
#include "tests/client/fake_server.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/frame_time.h"

#include <csignal>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace fieldcast::test {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using testing::HasSubstr;

constexpr auto kLongestRun = 60s;

void stream(FakeCall& call, int /*number*/) {
    const wire::ViewSet set = call.grant();
    for (std::uint64_t id = 1;; ++id) {
        call.send(views_messages(set, id));
        if (!call.read_until(v1::ClientMessage::kFrameAck)) {
            return;
        }
        pass_frame_time(10ms);
    }
}

class LoadProgram : public testing::Test {
protected:
    /// Runs to its end; its text is in `text_`.
    int run(std::vector<std::string> arguments) {
        Program program(FIELDCAST_LOAD, std::move(arguments), folder_ / "output.txt");
        const int code = program.exit_code(kLongestRun).value_or(-1);
        text_ = program.text();
        return code;
    }

    const TestFolder folder_;
    FakeServer server_{stream};
    std::string text_;
};

TEST_F(LoadProgram, ReportsAndWritesFiles) {
    const std::string json = folder_ / "load.json";
    const std::string html = folder_ / "load.html";
    const std::string hgrm = folder_ / "hgrm";
    EXPECT_EQ(run({"--clients", "3", "--grid", "1x2", "--duration", "1", "--json", json, "--html", html, "--hgrm", hgrm,
                   "--require", "most_lost=0", server_.address()}),
              0)
        << text_;
    EXPECT_THAT(text_, HasSubstr("clients                  3")); // a row of the table
    EXPECT_THAT(text_, HasSubstr("ok     clients: most_lost 0, limit 0"));
    const auto result = nlohmann::json::parse(text_of(json));
    EXPECT_EQ(result["clients"], 3);
    EXPECT_GT(result["groups"][0]["frames"], 3);
    EXPECT_THAT(text_of(html), HasSubstr("</html>"));
    EXPECT_THAT(text_of(folder_ / "hgrm/clients.decode.hgrm"), HasSubstr("#[Max"));
}

TEST_F(LoadProgram, ExitCodesTellWhatHappened) {
    EXPECT_EQ(run({"--duration", "0.5", "--grid", "1x2", "--require", "least_fps=1000", server_.address()}), 3);
    EXPECT_THAT(text_, HasSubstr("MISSED clients: least_fps"));
    EXPECT_EQ(run({"--duration", "0.5", "--grid", "1x2", "127.0.0.1:1"}), 1);
    EXPECT_THAT(text_, HasSubstr("no client received a frame"));
    EXPECT_EQ(run({"--duration", "-1", server_.address()}), 2);
    EXPECT_EQ(run({"--scenario", folder_ / "none.toml", server_.address()}), 2);
    EXPECT_THAT(text_, HasSubstr("none.toml: cannot be read"));
    EXPECT_EQ(run({"--check", "--scenario", "bench/load/mixed.toml"}), 0);
    EXPECT_EQ(run({"--duration", "0.5", "--grid", "1x2", "--json", folder_ / "no/such/folder", server_.address()}), 2);
}

TEST_F(LoadProgram, CtrlCEndsItWithAReport) {
    Program program(FIELDCAST_LOAD, {"--duration", "0", "--clients", "2", "--grid", "1x2", server_.address()},
                    folder_ / "output.txt");
    ASSERT_TRUE(program.has_said("2 of 2 connected", 30s)) << program.text();
    program.send_signal(SIGINT);
    EXPECT_EQ(program.exit_code(kLongestRun), 0);
    EXPECT_THAT(program.text(), HasSubstr("(interrupted)"));
}

} // namespace
} // namespace fieldcast::test
