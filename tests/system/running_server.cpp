// SPDX-License-Identifier: Apache-2.0
#include "running_server.h"

#include "tests/fixtures/http_client.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/test_folder.h"

#include <atomic>

namespace fieldcast::test {

namespace {

using namespace std::chrono_literals;

constexpr auto kStartPatience = 240s; // a software device under sanitizers on a busy machine

std::vector<std::string> arguments(const std::filesystem::path& folder, const std::vector<std::string>& flags) {
    std::vector<std::string> all{"--scene",          "scenes/atelier/atelier.gltf",
                                 "--size",           "64x36",
                                 "--clock",          "frames",
                                 "--listen",         "127.0.0.1:0",
                                 "--port-file",      folder / "port",
                                 "--metrics-listen", "127.0.0.1:0",
                                 "--metrics-port-file", folder / "metrics-port"};
    all.insert(all.end(), flags.begin(), flags.end());
    return all;
}

} // namespace

RunningServer::Folder::Folder() {
    static std::atomic<int> count = 0;
    const std::string name = "running_server_" + std::to_string(getpid()) + "_" + std::to_string(++count);
    path = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
}

RunningServer::Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
}

RunningServer::RunningServer(const std::string& program, const std::vector<std::string>& flags)
    : process_(program, arguments(folder_.path, flags), folder_.path / "server.log"),
      is_serving_(process_.has_said("SERVING", kStartPatience)) {
    if (is_serving_) {
        port_ = std::stoi(text_of(folder_.path / "port"));
        metrics_port_ = std::stoi(text_of(folder_.path / "metrics-port"));
    }
}

bool RunningServer::lacks_device() const {
    EXPECT_TRUE(is_serving_ || log().find("Vulkan d") != std::string::npos) << log();
    return !is_serving_;
}

std::string RunningServer::metrics() const {
    const std::string answer = http_get(metrics_port_, "GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::size_t head_end = answer.find("\r\n\r\n");
    return head_end == std::string::npos ? "" : answer.substr(head_end + 4);
}

double RunningServer::value_on(const std::string& page, const std::string& series) {
    const std::string lines = "\n" + page;
    const std::size_t line = lines.find("\n" + series + " ");
    return line == std::string::npos ? -1.0 : std::stod(lines.substr(line + series.size() + 2));
}

testing::AssertionResult RunningServer::shows(const std::string& series, double value,
                                              std::chrono::seconds patience) const {
    double now = 0.0;
    if (comes_true([&] { return (now = metric(series)) == value; }, patience)) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << series << " is " << now << " instead of " << value;
}

} // namespace fieldcast::test
