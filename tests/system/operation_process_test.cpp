// SPDX-License-Identifier: Apache-2.0
// What operators look at, on a server that renders: /metrics, --health, logs.
#include "running_server.h"
#include "tests/fixtures/certificate_authority.h"
#include "tests/fixtures/http_client.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/server_client.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <sys/socket.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kPatience = 60s;

class Operation : public testing::Test {
protected:
    void SetUp() override {
        if (server_.lacks_device()) {
            GTEST_SKIP() << server_.log();
        }
    }

    /// Exit code of `fieldcast-server --health`; what it says goes to `said_`.
    std::optional<int> probe(const std::string& address) {
        Program program(FIELDCAST_SERVER, {"--health", address}, folder_ / "health.txt");
        const auto code = program.exit_code(kPatience);
        said_ = program.text();
        return code;
    }

    /// Gets one frame in that mode and acknowledges it.
    static void watch(OpenCall& call, v1::DeliveryMode mode) {
        v1::Configure wanted;
        wanted.add_modes(mode);
        wanted.mutable_grid()->set_rows(2);
        wanted.mutable_grid()->set_cols(3);
        call.configure(wanted);
        const auto trailer = call.read_frame();
        ASSERT_TRUE(trailer.has_value()) << "the stream ended";
        call.acknowledge(*trailer);
    }

    const TestFolder folder_;
    RunningServer server_{FIELDCAST_SERVER, {"--log-format", "json", "--max-opens-per-second-per-peer", "1000000"}};
    std::string said_;
};

TEST_F(Operation, MetricsTellWhatWasRenderedAndSent) {
    OpenCall thin(connect(server_.port()));
    OpenCall thick(connect(server_.port()));
    watch(thin, v1::DELIVERY_MODE_VIEWS);
    watch(thick, v1::DELIVERY_MODE_SCENE);
    const std::string page = server_.metrics();
    for (const char* const series :
         {"fieldcast_stage_seconds_count{channel=\"atelier\",stage=\"source_trace\"}",
          "fieldcast_render_seconds_count{channel=\"atelier\"}", "fieldcast_encode_seconds_count{channel=\"atelier\"}",
          "fieldcast_frames_rendered_total{channel=\"atelier\"}", "fieldcast_view_pixels_total{channel=\"atelier\"}",
          "fieldcast_hole_pixels_total{channel=\"atelier\",reason=\"id\"}",
          "fieldcast_plane_bytes_total{channel=\"atelier\",plane=\"colour\",codec=\"zstd\"}",
          "fieldcast_plane_bytes_total{channel=\"atelier\",plane=\"diffuse\",codec=\"zstd\"}",
          "fieldcast_sent_bytes_total{channel=\"atelier\"}", "process_resident_memory_bytes"}) {
        EXPECT_GT(server_.metric(series), 0.0) << series << " in\n" << page;
    }
    EXPECT_EQ(server_.metric("fieldcast_sessions{channel=\"atelier\",mode=\"views\",grid=\"2x3\"}"), 1.0);
    EXPECT_EQ(server_.metric("fieldcast_sessions{channel=\"atelier\",mode=\"scene\",grid=\"2x3\"}"), 1.0);
    EXPECT_EQ(server_.metric("fieldcast_sessions_opened_total"), 2.0);
    EXPECT_EQ(server_.metric("fieldcast_invalid_samples_total{channel=\"atelier\"}"), 0.0);
}

TEST_F(Operation, HealthIsTrueWhileServingAndWhileDraining) {
    const std::string address = "127.0.0.1:" + std::to_string(server_.port());
    EXPECT_EQ(probe(address), 0);
    EXPECT_EQ(said_, "SERVING\n");
    OpenCall call(connect(server_.port()));
    watch(call, v1::DELIVERY_MODE_VIEWS);
    server_.process().send_signal(SIGTERM);
    ASSERT_TRUE(call.read_until(v1::ServerMessage::kGoingAway).has_value());
    EXPECT_EQ(probe(address), 1);
    EXPECT_EQ(said_, "NOT_SERVING\n");
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    EXPECT_EQ(server_.process().exit_code(kPatience), 0) << server_.log();
    EXPECT_EQ(probe(address), 1) << "nobody listens any more";
    EXPECT_THAT(said_, HasSubstr(address));
}

TEST_F(Operation, EveryLineOfTheLogIsAnObject) {
    {
        OpenCall call(connect(server_.port()));
        watch(call, v1::DELIVERY_MODE_VIEWS);
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
    }
    server_.process().send_signal(SIGTERM);
    EXPECT_EQ(server_.process().exit_code(kPatience), 0);
    std::set<std::string> events;
    std::istringstream lines(server_.log());
    for (std::string line; std::getline(lines, line);) {
        const auto object = nlohmann::json::parse(line, nullptr, false);
        ASSERT_TRUE(object.is_object()) << line;
        EXPECT_EQ(object.at("time").get<std::string>().size(), std::string("2026-07-31T12:00:00.123Z").size());
        events.insert(object.at("event").get<std::string>());
        if (object.at("event") == "session closed") {
            EXPECT_EQ(object.at("reason"), "finished");
            EXPECT_GE(object.at("frames").get<int>(), 1);
        }
    }
    EXPECT_THAT(events, testing::IsSupersetOf({"channel ready", "SERVING", "session opened", "session closed"}));
}

/// Names of ours, and of the process, that stand in a text; of a histogram's series the histogram's name.
std::set<std::string> metric_names(const std::string& text) {
    constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyz_";
    std::set<std::string> names;
    for (std::size_t begin = text.find_first_of(kLetters); begin != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_not_of(kLetters, begin), text.size());
        std::string name = text.substr(begin, end - begin);
        for (const std::string_view part : {"_bucket", "_sum", "_count"}) {
            name.resize(name.ends_with(part) ? name.size() - part.size() : name.size());
        }
        if (name.starts_with("fieldcast_") || name.starts_with("process_")) {
            names.insert(name);
        }
        begin = text.find_first_of(kLetters, end);
    }
    return names;
}

/// Names that /metrics announces.
std::set<std::string> announced_names(const std::string& page) {
    std::istringstream words(page);
    std::set<std::string> names;
    for (std::string word; words >> word;) {
        if (word == "TYPE" && words >> word) {
            names.insert(word);
        }
    }
    return names;
}

/// Without what follows # in its lines.
std::string without_comments(const std::string& text) {
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);) {
        kept += line.substr(0, line.find('#')) + '\n';
    }
    return kept;
}

std::string expressions(const nlohmann::json& node) {
    std::string text;
    for (const auto& [key, value] : node.items()) {
        text += value.is_structured()                  ? expressions(value)
                : (key == "expr" || key == "query") ? value.get<std::string>() + "\n"
                                                       : "";
    }
    return text;
}

/// With TLS, so that there is a certificate whose end can be told.
class EncryptedOperation : public testing::Test {
protected:
    EncryptedOperation() {
        const Issued issued = authority_.issue();
        write_file(folder_ / "cert.pem", issued.certificate);
        write_file(folder_ / "key.pem", issued.key);
    }

    const TestFolder folder_;
    const CertificateAuthority authority_;
};

TEST_F(EncryptedOperation, DashboardAlertsAndDocumentsNameMetricsThatExist) {
    const RunningServer server(FIELDCAST_SERVER,
                               {"--tls-cert", folder_ / "cert.pem", "--tls-key", folder_ / "key.pem"});
    if (server.lacks_device()) {
        GTEST_SKIP() << server.log();
    }
    OpenCall call(connect(server.port(), grpc::SslCredentials({.pem_root_certs = authority_.certificate(),
                                                               .pem_private_key = {},
                                                               .pem_cert_chain = {}})));
    call.configure();
    ASSERT_TRUE(call.read_frame().has_value());
    const std::set<std::string> known = announced_names(server.metrics());
    ASSERT_TRUE(known.contains("fieldcast_sessions"));
    const std::set<std::string> drawn =
        metric_names(expressions(nlohmann::json::parse(text_of("deploy/grafana-dashboard.json"))));
    EXPECT_GT(drawn.size(), 20U);
    EXPECT_THAT(known, testing::IsSupersetOf(drawn));
    const std::string alerts = without_comments(text_of("deploy/alerts.yml"));
    EXPECT_FALSE(metric_names(alerts).empty());
    EXPECT_THAT(known, testing::IsSupersetOf(metric_names(alerts)));
    const std::string documents = text_of("docs/operations.md");
    for (const std::string& name : known) {
        EXPECT_TRUE(name.starts_with("process_") || documents.find("`" + name + "`") != std::string::npos)
            << name << " is not in docs/operations.md";
    }
}

/// Clients that come and go in every way, one after the other.
class Churn : public Operation {
protected:
    /// With AddressSanitizer freed memory waits in a quarantine of 256 MB, and would count as held.
    static void SetUpTestSuite() { ::setenv("ASAN_OPTIONS", "quarantine_size_mb=8", 0); }

    void come_and_go(int kind) const {
        if (kind < 2) {
            const HttpCaller caller("127.0.0.1", server_.port());
            constexpr std::string_view kPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
            ::send(caller.descriptor(), kPreface.data(), kind == 0 ? 0 : kPreface.size() / 2, MSG_NOSIGNAL);
            return; // dies
        }
        OpenCall call(connect(server_.port()));
        v1::Configure wanted;
        wanted.mutable_grid()->set_rows(1);
        wanted.mutable_grid()->set_cols(2);
        call.configure(wanted);
        if (kind == 2) {
            call.cancel(); // before anything was heard
        } else if (kind == 3) {
            EXPECT_TRUE(call.read_until(v1::ServerMessage::kFrameChunk).has_value());
            call.cancel(); // in the middle of a frame
        } else {
            const auto trailer = call.read_frame();
            EXPECT_TRUE(trailer && call.acknowledge(*trailer));
            call.half_close();
        }
        EXPECT_EQ(call.finish().ok(), kind == 4);
    }

    void come_and_go_many(int count) const {
        for (int i = 0; i < count; ++i) {
            come_and_go(i % 5);
        }
    }

    /// Killed in the middle of a stream.
    void kill_a_client() {
        const double opened = server_.metric("fieldcast_sessions_opened_total");
        const Program client(FIELDCAST_CLIENT,
                             {"--server", "127.0.0.1:" + std::to_string(server_.port()), "--grid", "1x2", "--mode",
                              "views", "--frames", "100000", "--out", folder_ / "out"},
                             folder_ / "client.log");
        EXPECT_TRUE(server_.shows("fieldcast_sessions_opened_total", opened + 1, kPatience));
        client.send_signal(SIGKILL);
    }

    /// Waits until nobody is left; the number of open files then.
    double open_files_without_clients() const {
        const auto nobody_is_left = [&] {
            return server_.metrics().find("\nfieldcast_sessions{") == std::string::npos;
        };
        EXPECT_TRUE(comes_true(nobody_is_left, kPatience)) << "sessions are left over:\n" << server_.metrics();
        return server_.metric("process_open_fds");
    }
};

TEST_F(Churn, AThousandClientsLeaveNothingBehind) {
    come_and_go_many(50); // lets gRPC make its pollers and the allocator its arenas
    const double files_before = open_files_without_clients();
    come_and_go_many(450);
    const double memory_half_way = server_.metric("process_resident_memory_bytes");
    come_and_go_many(500);
    for (int i = 0; i < 3; ++i) {
        kill_a_client();
    }
    EXPECT_TRUE(comes_true([&] { return open_files_without_clients() <= files_before; }, kPatience))
        << "sockets close a moment after their session, but not these: " << server_.metric("process_open_fds")
        << " instead of " << files_before;
    const double opened = server_.metric("fieldcast_sessions_opened_total");
    EXPECT_GT(opened, 0.0);
    double closed = 0.0;
    for (const char* const reason : {"finished", "cancelled", "invalid", "not_configured", "stalled", "not_reading",
                                     "flooding", "drained", "revoked", "failed"}) {
        closed += server_.metric("fieldcast_sessions_closed_total{reason=\"" + std::string(reason) + "\"}");
    }
    EXPECT_EQ(closed, opened);
    EXPECT_EQ(server_.metric("fieldcast_sessions_closed_total{reason=\"failed\"}"), 0.0);
    // 500 leaked sessions of a mailbox, a frame and a gRPC call would be far above: a call alone is about 30 KiB.
    EXPECT_LT(server_.metric("process_resident_memory_bytes") - memory_half_way, 8e6);
}

} // namespace
} // namespace fieldcast::test
