// SPDX-License-Identifier: Apache-2.0
// The numbers, the page that shows them and who may read it.
#include "certificate_authority.h"
#include "core/base/error.h"
#include "http_client.h"
#include "server/metrics/http_endpoint.h"
#include "server/metrics/process_metrics.h"
#include "server/metrics/registry.h"
#include "test_folder.h"

#include <gmock/gmock.h>
#include <thread>

namespace fieldcast::metrics {
namespace {

using test::CertificateAuthority;
using test::http_get;
using test::TestFolder;
using test::write_file;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::array kBounds{0.1, 1.0};

TEST(Histogram, CountsEachValueUnderEveryBoundThatItDoesNotExceed) {
    Histogram histogram(kBounds);
    for (const double value : {0.05, 0.1, 0.5, 2.0, 3.0}) {
        histogram.observe(value);
    }
    EXPECT_EQ(histogram.cumulative_counts(), (std::vector<std::uint64_t>{2, 3, 5}));
    EXPECT_DOUBLE_EQ(histogram.sum(), 5.65);
}

TEST(Page, IsPrometheusText) {
    Page page;
    Histogram histogram(kBounds);
    histogram.observe(0.5);
    page.add_gauge({"b_bytes", "Bytes."}, {{"name", "a \"b\" \\ c\nd"}}, 1.5);
    page.add_histogram({"c_seconds", "Times."}, {{"stage", "x"}}, histogram);
    page.add_counter({"a_total", "Events."}, {}, 12345678901234.0);
    page.add_gauge({"b_bytes", "Bytes."}, {{"name", "e"}}, 0.0);
    EXPECT_EQ(page.text(), "# HELP a_total Events.\n# TYPE a_total counter\na_total 12345678901234\n"
                           "# HELP b_bytes Bytes.\n# TYPE b_bytes gauge\n"
                           "b_bytes{name=\"a \\\"b\\\" \\\\ c\\nd\"} 1.5\nb_bytes{name=\"e\"} 0\n"
                           "# HELP c_seconds Times.\n# TYPE c_seconds histogram\n"
                           "c_seconds_bucket{stage=\"x\",le=\"0.1\"} 0\nc_seconds_bucket{stage=\"x\",le=\"1\"} 1\n"
                           "c_seconds_bucket{stage=\"x\",le=\"+Inf\"} 1\n"
                           "c_seconds_sum{stage=\"x\"} 0.5\nc_seconds_count{stage=\"x\"} 1\n");
}

TEST(Registry, GivesTheSameInstrumentForTheSameLabels) {
    Registry registry;
    Counter& one = registry.counter({"a_total", "A."}, {{"x", "1"}});
    Counter& two = registry.counter({"a_total", "A."}, {{"x", "2"}});
    registry.counter({"a_total", "A."}, {{"x", "1"}}).add(3);
    EXPECT_EQ(one.value(), 3U);
    EXPECT_EQ(two.value(), 0U);
    EXPECT_THAT(registry.page().text(), HasSubstr("a_total{x=\"1\"} 3\na_total{x=\"2\"} 0\n"));
}

TEST(Registry, AsksCollectorsWhileTheyLive) {
    Registry registry;
    {
        const Collector collector = registry.on_collect([](Page& page) { page.add_gauge({"g", "G."}, {}, 7.0); });
        EXPECT_THAT(registry.page().text(), HasSubstr("g 7\n"));
    }
    EXPECT_THAT(registry.page().text(), Not(HasSubstr("g 7")));
}

TEST(Registry, CountsFromManyThreads) {
    Registry registry;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 10'000; ++k) {
                registry.counter({"a_total", "A."}, {}).add();
                registry.histogram({"h_seconds", "H."}, {}, kBounds).observe(0.5);
            }
        });
    }
    registry.page();
    threads.clear();
    EXPECT_EQ(registry.counter({"a_total", "A."}, {}).value(), 40'000U);
    EXPECT_DOUBLE_EQ(registry.histogram({"h_seconds", "H."}, {}, kBounds).sum(), 20'000.0);
}

TEST(ProcessMetrics, AreThoseOfThisProcess) {
    Page page;
    add_process_metrics(page);
    const std::string text = page.text();
    for (const char* const name : {"process_cpu_seconds_total ", "process_resident_memory_bytes ", "process_threads ",
                                   "process_open_fds ", "process_max_fds ", "process_virtual_memory_bytes "}) {
        EXPECT_THAT(text, HasSubstr("\n" + std::string(name)));
    }
    const auto value_of = [&](const std::string& name) {
        return std::stod(text.substr(text.find("\n" + name + " ") + name.size() + 2));
    };
    EXPECT_GT(value_of("process_resident_memory_bytes"), 1e6); // no C++ program with gtest is smaller
    EXPECT_LT(value_of("process_resident_memory_bytes"), value_of("process_virtual_memory_bytes"));
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    EXPECT_NEAR(value_of("process_start_time_seconds"), static_cast<double>(now), 600.0); // started minutes ago at most
}

TEST(HttpRequest, ReadsMethodPathAndAuthorization) {
    const auto request =
        parse_http_request("GET /metrics?x=1 HTTP/1.1\r\nHost: a\r\nAUTHORIZATION:  Bearer t \r\n\r\n");
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->method, "GET");
    EXPECT_EQ(request->path, "/metrics");
    EXPECT_EQ(request->authorization, "Bearer t");
    EXPECT_TRUE(parse_http_request("GET / HTTP/1.0\r\n\r\n").has_value());
}

TEST(HttpRequest, RefusesEverythingElse) {
    for (const char* const head :
         {"", "\r\n\r\n", "GET\r\n\r\n", "GET /\r\n\r\n", "GET / HTTP/2\r\n\r\n", " / HTTP/1.1\r\n\r\n",
          "GET metrics HTTP/1.1\r\n\r\n", "GET / x HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\n",
          "GET / HTTP/1.1\r\nno colon\r\n\r\n", "GET / HTTP/1.1\r\n: x\r\n\r\n",
          "GET / HTTP/1.1\r\nAuthorization: a\r\nauthorization: b\r\n\r\n", "GET / HTTP/1.1\n\n"}) {
        EXPECT_EQ(parse_http_request(head), std::nullopt) << head;
    }
}

class Endpoint : public testing::Test {
protected:
    Endpoint() {
        const test::Issued issued = authority_.issue();
        write_file(folder_ / "cert.pem", issued.certificate);
        write_file(folder_ / "key.pem", issued.key);
        gate_.replace(access::TokenList::parse(line("viewer", access::Role::kView, "fc_viewer") +
                                                   line("scraper", access::Role::kAdmin, "fc_scraper"),
                                               "t"));
        security_.certificates = {.certificate = folder_ / "cert.pem", .key = folder_ / "key.pem", .client_ca = {}};
        security_.tokens = folder_ / "tokens.txt";
    }

    static std::string line(const std::string& name, access::Role role, const std::string& token) {
        return access::token_line({.name = name, .role = role, .hash = access::hash_token(token)}) + "\n";
    }

    static std::string page() { return "a_total 1\n"; }

    const TestFolder folder_;
    const CertificateAuthority authority_;
    access::Gate gate_;
    access::Security security_;
};

TEST_F(Endpoint, ShowsThePageOnLoopback) {
    const HttpEndpoint endpoint({.host = "127.0.0.1", .port = 0}, {}, gate_, page);
    const std::string answer = http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_THAT(answer, AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), HasSubstr("text/plain; version=0.0.4"),
                              HasSubstr("Content-Length: 10\r\n"), testing::EndsWith("\r\n\r\na_total 1\n")));
    EXPECT_THAT(http_get(endpoint.port(), "HEAD /metrics HTTP/1.1\r\n\r\n"),
                AllOf(StartsWith("HTTP/1.1 200"), Not(HasSubstr("a_total"))));
    EXPECT_THAT(http_get(endpoint.port(), "GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(http_get(endpoint.port(), "POST /metrics HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 405"));
    EXPECT_THAT(http_get(endpoint.port(), "hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(http_get(endpoint.port(), std::string(kMaxHeadBytes + 1, 'x')), StartsWith("HTTP/1.1 400"));
}

TEST_F(Endpoint, SilentCallersDoNotKeepOthersOut) {
    const HttpEndpoint endpoint({.host = "[::1]", .port = 0}, {}, gate_, page);
    const test::HttpCaller silent("::1", endpoint.port());
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THAT(http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n", "::1"), HasSubstr("a_total 1"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8)); // it is cut after two
}

TEST_F(Endpoint, AsksForTlsAndTokensBeyondLoopback) {
    access::Security tls_only = security_;
    tls_only.tokens.reset();
    for (const access::Security& security : {access::Security{}, tls_only}) {
        EXPECT_THROW(HttpEndpoint({.host = "0.0.0.0", .port = 0}, security, gate_, page), UserError);
    }
    const HttpEndpoint endpoint({.host = "0.0.0.0", .port = 0}, security_, gate_, page);
    const auto get = [&](const std::string& token) {
        const std::string header = token.empty() ? "" : "Authorization: Bearer " + token + "\r\n";
        return test::https_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n" + header + "\r\n",
                               authority_.certificate());
    };
    EXPECT_THAT(get("fc_scraper"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("a_total 1")));
    EXPECT_THAT(get(""), AllOf(StartsWith("HTTP/1.1 401"), HasSubstr("WWW-Authenticate: Bearer")));
    EXPECT_THAT(get("fc_wrong"), StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(get("fc_viewer"), AllOf(StartsWith("HTTP/1.1 403"), HasSubstr("needs admin")));
    EXPECT_THAT(http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n"), Not(HasSubstr("a_total")));
    EXPECT_EQ(test::https_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n", CertificateAuthority().certificate()),
              "");
    EXPECT_THAT(get("fc_scraper"), HasSubstr("a_total 1")) << "still alive";
}

TEST_F(Endpoint, PortsInUseAreRefused) {
    const HttpEndpoint first({.host = "127.0.0.1", .port = 0}, {}, gate_, page);
    EXPECT_THROW(HttpEndpoint({.host = "127.0.0.1", .port = first.port()}, {}, gate_, page), std::runtime_error);
}

} // namespace
} // namespace fieldcast::metrics
