// SPDX-License-Identifier: Apache-2.0
// What the HTTP edge answers, and to whom.
#include "core/base/error.h"
#include "server/web/connection_table.h"
#include "tests/server/web_fixture.h"

#include <thread>

namespace fieldcast::web {
namespace {

using test::http_get;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ConnectionTable, GivesUpTheOldestOfANetworkThatHasTooMany) {
    ConnectionTable table({.total = 10, .per_network = 2});
    table.add("a");
    const auto first = table.add("b");
    const auto second = table.add("b");
    EXPECT_EQ(table.surplus(), std::nullopt);
    const auto third = table.add("b");
    EXPECT_EQ(table.surplus(), first);
    table.move_to(first, Stage::kAnswering);
    EXPECT_EQ(table.surplus(), second) << "who is sent an answer goes last";
    table.move_to(second, Stage::kAnswering);
    EXPECT_EQ(table.surplus(), first) << "not the newest one, though it has no answer yet";
    table.move_to(second, Stage::kParting);
    EXPECT_EQ(table.surplus(), second) << "who has its answer goes first";
    table.remove(second);
    EXPECT_EQ(table.surplus(), std::nullopt);
    table.remove(third);
    table.remove(third);
    EXPECT_EQ(table.first_to_go(), 1U);
}

TEST(ConnectionTable, GivesUpThoseOfTheLargestNetworkWhenAllAreTooMany) {
    ConnectionTable table({.total = 4, .per_network = 4});
    table.add("a");
    const auto crowd = table.add("b");
    table.add("b");
    table.add("c");
    EXPECT_EQ(table.surplus(), std::nullopt);
    table.add("d");
    EXPECT_EQ(table.surplus(), crowd);
    EXPECT_EQ(ConnectionTable({.total = 1, .per_network = 1}).surplus(), std::nullopt);
}

class Endpoint : public test::WebFixture {};

TEST_F(Endpoint, ShowsThePageOnLoopback) {
    const web::Endpoint endpoint(in_the_open(), gate_, routes());
    const std::string answer = http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_THAT(answer, AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), HasSubstr("text/plain; version=0.0.4"),
                              HasSubstr("Content-Length: 10\r\n"), testing::EndsWith("\r\n\r\na_total 1\n")));
    EXPECT_THAT(http_get(endpoint.port(), "HEAD /metrics HTTP/1.1\r\n\r\n"),
                AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("Content-Length: 10\r\n"), Not(HasSubstr("a_total"))));
    EXPECT_THAT(http_get(endpoint.port(), "GET / HTTP/1.1\r\n\r\n"),
                AllOf(StartsWith("HTTP/1.1 404"), HasSubstr("/metrics")));
    EXPECT_THAT(http_get(endpoint.port(), "POST /metrics HTTP/1.1\r\nContent-Length: 1\r\n\r\nx"),
                AllOf(StartsWith("HTTP/1.1 405"), HasSubstr("Allow: GET, HEAD\r\n")));
    EXPECT_THAT(http_get(endpoint.port(), "hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(http_get(endpoint.port(), std::string(Limits{}.head_bytes + 1, 'x')), StartsWith("HTTP/1.1 400"));
}

TEST_F(Endpoint, AnswersOneRequestPerConnection) {
    const web::Endpoint endpoint(in_the_open(), gate_, routes());
    const std::string request = "GET /metrics HTTP/1.1\r\nConnection: keep-alive\r\n\r\n";
    const std::string answer = http_get(endpoint.port(), request + request);
    EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
    EXPECT_EQ(answer.find("HTTP/1.1"), answer.rfind("HTTP/1.1"));
}

TEST_F(Endpoint, APageThatFailsIsAnAnswerOfItsOwn) {
    auto broken = routes();
    broken[0].get = [](const Request&) -> Answer { throw std::runtime_error("secret"); };
    const web::Endpoint endpoint(in_the_open(), gate_, broken);
    for (int i = 0; i < 3; ++i) {
        EXPECT_THAT(http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n"),
                    AllOf(StartsWith("HTTP/1.1 500"), Not(HasSubstr("secret"))));
    }
}

TEST_F(Endpoint, AsksForTlsAndTokensBeyondLoopback) {
    Listening bare = over_tls();
    bare.security = {};
    Listening tls_only = over_tls();
    tls_only.security.tokens.reset();
    for (const Listening& listening : {bare, tls_only}) {
        EXPECT_THROW(web::Endpoint(listening, gate_, routes()), UserError);
    }
    const web::Endpoint endpoint(over_tls(), gate_, routes());
    EXPECT_THAT(scrape(endpoint.port()), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("a_total 1")));
    EXPECT_THAT(scrape(endpoint.port(), ""), AllOf(StartsWith("HTTP/1.1 401"), HasSubstr("WWW-Authenticate: Bearer")));
    EXPECT_THAT(scrape(endpoint.port(), "fc_wrong"), StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(scrape(endpoint.port(), "fc_viewer"), AllOf(StartsWith("HTTP/1.1 403"), HasSubstr("needs admin")));
    EXPECT_THAT(http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n"), Not(HasSubstr("a_total")));
    EXPECT_EQ(
        test::https_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n", test::CertificateAuthority().certificate()),
        "");
    EXPECT_THAT(scrape(endpoint.port()), HasSubstr("a_total 1")) << "still alive";
}

TEST_F(Endpoint, AsksForTheCertificateOfTheCallerWhereAuthoritiesAreNamed) {
    test::write_file(folder_ / "clients.pem", test::CertificateAuthority().certificate());
    security_.certificates->client_ca = folder_ / "clients.pem";
    const web::Endpoint endpoint(over_tls(), gate_, routes());
    EXPECT_EQ(scrape(endpoint.port()), "");
}

TEST_F(Endpoint, TakesUpANewCertificateAndKeepsTheOldOneWhileFilesAreBroken) {
    const web::Endpoint endpoint(over_tls(), gate_, routes());
    EXPECT_THAT(scrape(endpoint.port()), HasSubstr("a_total 1"));
    test::write_file(folder_ / "key.pem", "no key");
    EXPECT_THAT(scrape(endpoint.port()), HasSubstr("a_total 1")) << "the earlier one stays in force";
    const test::CertificateAuthority other;
    const test::Issued issued = other.issue();
    test::write_file(folder_ / "cert.pem", issued.certificate);
    test::write_file(folder_ / "key.pem", issued.key);
    EXPECT_EQ(scrape(endpoint.port()), "") << "signed by somebody else now";
    const std::string request = "GET /metrics HTTP/1.1\r\nAuthorization: Bearer fc_scraper\r\n\r\n";
    EXPECT_THAT(test::https_get(endpoint.port(), request, other.certificate()), HasSubstr("a_total 1"));
}

TEST_F(Endpoint, CertificatesThatAreNotUsableAreRefusedAtTheStart) {
    test::write_file(folder_ / "key.pem", "no key");
    EXPECT_THROW(web::Endpoint(over_tls(), gate_, routes()), UserError);
}

TEST_F(Endpoint, PortsInUseAreRefused) {
    const web::Endpoint first(in_the_open(), gate_, routes());
    EXPECT_THROW(web::Endpoint(in_the_open("127.0.0.1", first.port()), gate_, routes()), std::runtime_error);
}

TEST_F(Endpoint, AnswersManyAtOnce) {
    const web::Endpoint endpoint(in_the_open("[::1]"), gate_, routes(std::string(1'000'000, 'x')));
    std::vector<std::jthread> callers;
    std::array<std::string, 8> answers; // as many as one network may have
    for (std::string& answer : answers) {
        callers.emplace_back([&] { answer = http_get(endpoint.port(), "GET /metrics HTTP/1.1\r\n\r\n", "::1"); });
    }
    callers.clear();
    for (const std::string& answer : answers) {
        EXPECT_GT(answer.size(), 1'000'000U);
    }
}

} // namespace
} // namespace fieldcast::web
