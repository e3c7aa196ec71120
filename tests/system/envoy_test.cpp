// SPDX-License-Identifier: Apache-2.0
// Through a real Envoy with deploy/envoy.yaml: gRPC over HTTP/2 and gRPC-Web, with the stream lengths and half-closes
// that proxies truncate when either side ends a stream before the other.
#include "tests/fixtures/certificate_authority.h"
#include "tests/fixtures/http_client.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/served_channel.h"
#include "tests/server/session_count.h"

#include <csignal>
#include <filesystem>
#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;
using Kind = v1::ServerMessage;

constexpr const char* kEnvoy = ".cache/envoy/bin/envoy"; // where tests/deploy/install_envoy.py puts it
constexpr auto kPatience = 60s;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

/// The port that stands behind `address` in a text; 0: none.
int port_after(const std::string& text, const std::string& address) {
    const std::size_t place = text.find(address);
    return place == std::string::npos ? 0 : std::atoi(text.c_str() + place + address.size());
}

class Envoy : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(kEnvoy)) {
            GTEST_SKIP() << "no Envoy at " << kEnvoy << "; tests/deploy/install_envoy.py installs it";
        }
        const Issued issued = authority_.issue();
        write_file(folder_ / "cert.pem", issued.certificate);
        write_file(folder_ / "key.pem", issued.key);
        std::string text = text_of("deploy/envoy.yaml");
        text = replaced(text, "/etc/fieldcast/cert.pem", folder_ / "cert.pem");
        text = replaced(text, "/etc/fieldcast/key.pem", folder_ / "key.pem");
        text = replaced(text, "0.0.0.0, port_value: 8443", "127.0.0.1, port_value: 0");
        text = replaced(text, "port_value: 50151", "port_value: " + std::to_string(served_.port()));
        text = replaced(text, "port_value: 9901", "port_value: 0");
        write_file(folder_ / "envoy.yaml", text);
    }

    std::vector<std::string> arguments(std::vector<std::string> further) const {
        const std::vector<std::string> always{"-c", folder_ / "envoy.yaml", "--concurrency", "1",
                                              "--use-dynamic-base-id"};
        further.insert(further.begin(), always.begin(), always.end());
        return further;
    }

    /// Whether it has told by now which free port it listens on for clients.
    bool has_told_port() {
        const int admin_port = port_after(text_of(folder_ / "admin"), "127.0.0.1:");
        if (admin_port != 0) {
            const std::string request = "GET /listeners HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
            port_ = port_after(http_get(admin_port, request), "clients::127.0.0.1:");
        }
        return port_ != 0;
    }

    /// Starts it and waits until it has found the server healthy.
    void start() {
        envoy_.emplace(kEnvoy, arguments({"--log-level", "warning", "--admin-address-path", folder_ / "admin"}),
                       folder_ / "envoy.log");
        ASSERT_TRUE(comes_true([&] { return has_told_port() || !envoy_->is_running(); }, kPatience));
        ASSERT_NE(port_, 0) << envoy_->text();
        const auto deadline = Clock::now() + kPatience;
        grpc::Status status(StatusCode::UNAVAILABLE, "");
        while (status.error_code() == StatusCode::UNAVAILABLE && Clock::now() < deadline && envoy_->is_running()) {
            std::string answer;
            status = call_raw(*dial(), "/fieldcast.v1.Catalog/GetServerInfo", "", answer);
        }
        ASSERT_TRUE(status.ok()) << status.error_message() << '\n' << envoy_->text();
    }

    std::shared_ptr<grpc::Channel> dial() const {
        return connect(port_, grpc::SslCredentials({.pem_root_certs = authority_.certificate(),
                                                    .pem_private_key = {},
                                                    .pem_cert_chain = {}}));
    }

    /// Reads and acknowledges so many frames. The number that came.
    static int watch(OpenCall& call, int count) {
        call.configure();
        for (int i = 0; i < count; ++i) {
            const auto trailer = call.read_frame();
            if (!trailer) {
                return i;
            }
            call.acknowledge(*trailer);
        }
        return count;
    }

    /// A unary or server streaming call as browsers make it; everything that comes back.
    std::string web_call(const std::string& method, const std::string& message) const {
        const auto byte = [&](unsigned shift) { return static_cast<char>((message.size() >> shift) & 0xFFU); };
        const std::string body = std::string(1, '\0') + byte(24) + byte(16) + byte(8) + byte(0) + message;
        return https_get(port_,
                         "POST " + method + " HTTP/1.1\r\nHost: fieldcast.example.org\r\nConnection: close\r\n" +
                             "Origin: https://fieldcast.example.org\r\nX-Grpc-Web: 1\r\n" +
                             "Content-Type: application/grpc-web+proto\r\nContent-Length: " +
                             std::to_string(body.size()) + "\r\n\r\n" + body,
                         authority_.certificate());
    }

    const TestFolder folder_;
    const CertificateAuthority authority_;
    ServedChannel served_{session::Limits()};
    int port_ = 0;
    std::optional<Program> envoy_;
};

TEST_F(Envoy, AcceptsItsConfiguration) {
    Program envoy(kEnvoy, arguments({"--mode", "validate"}), folder_ / "validate.log");
    EXPECT_EQ(envoy.exit_code(kPatience), 0) << envoy.text();
    EXPECT_THAT(envoy.text(), HasSubstr("OK"));
    write_file(folder_ / "envoy.yaml", replaced(text_of(folder_ / "envoy.yaml"), "codec_type", "kodec_type"));
    Program broken(kEnvoy, arguments({"--mode", "validate"}), folder_ / "validate.log");
    EXPECT_NE(broken.exit_code(kPatience), 0);
}

TEST_F(Envoy, StreamsEndWholeAfterAHalfClose) {
    ASSERT_NO_FATAL_FAILURE(start());
    const auto connection = dial();
    for (const int frames : {1, 2, 3, 5, 8, 13, 21, 34}) {
        OpenCall call(connection);
        EXPECT_EQ(watch(call, frames), frames);
        call.half_close();
        const grpc::Status status = call.finish();
        EXPECT_TRUE(status.ok()) << frames << " frames: " << status.error_message();
    }
    EXPECT_TRUE(served_.shows("fieldcast_sessions_closed_total{reason=\"finished\"}", 8));
}

TEST_F(Envoy, ALongStreamIsNotCut) {
    ASSERT_NO_FATAL_FAILURE(start());
    OpenCall call(dial());
    EXPECT_EQ(watch(call, 300), 300);
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Envoy, ADrainLosesNoStream) {
    ASSERT_NO_FATAL_FAILURE(start());
    const auto connection = dial();
    std::vector<std::unique_ptr<OpenCall>> calls;
    for (int i = 0; i < 12; ++i) {
        calls.push_back(std::make_unique<OpenCall>(connection));
        ASSERT_EQ(watch(*calls.back(), 1), 1);
    }
    served_.server().begin_drain("a test");
    for (auto& call : calls) {
        EXPECT_TRUE(call->read_until(Kind::kGoingAway).has_value());
        call->half_close();
        EXPECT_TRUE(call->finish().ok());
    }
    EXPECT_TRUE(served_.shows("fieldcast_sessions_closed_total{reason=\"drained\"}", 12));
}

TEST_F(Envoy, AClientThatVanishesBehindItIsForgotten) {
    ASSERT_NO_FATAL_FAILURE(start());
    auto connection = dial();
    auto call = std::make_unique<OpenCall>(connection);
    ASSERT_EQ(watch(*call, 2), 2);
    call->cancel();
    EXPECT_FALSE(call->finish().ok());
    EXPECT_TRUE(served_.shows("fieldcast_sessions_closed_total{reason=\"cancelled\"}", 1));
    EXPECT_TRUE(test::comes_to_sessions(served_.server(), 0));
}

TEST_F(Envoy, BrowsersGetAnswersAndWholeScenes) {
    ASSERT_NO_FATAL_FAILURE(start());
    const std::string info = web_call("/fieldcast.v1.Catalog/GetServerInfo", "");
    EXPECT_THAT(info, testing::StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(info, HasSubstr("access-control-allow-origin: https://fieldcast.example.org"));
    EXPECT_THAT(info, HasSubstr("grpc-status:0"));
    const feed::ChannelInfo channel = synthetic_info();
    v1::FetchSceneRequest request;
    request.set_scene_hash(channel.scene_hash.data(), channel.scene_hash.size());
    const std::string scene = web_call("/fieldcast.v1.Catalog/FetchScene", request.SerializeAsString());
    EXPECT_GT(scene.size(), channel.bundle->size());
    EXPECT_THAT(scene.substr(scene.size() - std::min<std::size_t>(scene.size(), 200)), HasSubstr("grpc-status:0"))
        << "the trailers stand at the end: nothing is missing";
    EXPECT_THAT(web_call("/fieldcast.v1.Catalog/FetchScene", ""), HasSubstr("grpc-status: 3")) << "INVALID_ARGUMENT";
}

TEST_F(Envoy, OurClientComesThrough) {
    ASSERT_NO_FATAL_FAILURE(start());
    write_file(folder_ / "ca.pem", authority_.certificate());
    Program client(FIELDCAST_CLIENT,
                   {"--server", "https://127.0.0.1:" + std::to_string(port_), "--tls-ca", folder_ / "ca.pem", "--mode",
                    "views", "--grid", "2x3", "--frames", "20", "--patience", "20", "--out", folder_ / "out"},
                   folder_ / "client.log");
    EXPECT_EQ(client.exit_code(kPatience), 0) << client.text();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out")) << client.text();
    EXPECT_TRUE(served_.shows("fieldcast_sessions_closed_total{reason=\"finished\"}", 1)) << "it half-closed";
}

} // namespace
} // namespace fieldcast::test
