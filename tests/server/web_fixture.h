// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/web/endpoint.h"
#include "tests/fixtures/certificate_authority.h"
#include "tests/fixtures/http_client.h"
#include "tests/fixtures/test_folder.h"

#include <gmock/gmock.h>

namespace fieldcast::test {

/// What an HTTP endpoint needs: a certificate, two tokens, and a page at /metrics.
class WebFixture : public testing::Test {
protected:
    WebFixture() {
        issue_certificate();
        gate_.replace(access::TokenList::parse(line("viewer", access::Role::kView, "fc_viewer") +
                                                   line("scraper", access::Role::kAdmin, "fc_scraper"),
                                               "t"));
        security_.certificates = {.certificate = folder_ / "cert.pem", .key = folder_ / "key.pem", .client_ca = {}};
        security_.tokens = folder_ / "tokens.txt";
    }

    static std::string line(const std::string& name, access::Role role, const std::string& token) {
        return access::token_line({.name = name, .role = role, .hash = access::hash_token(token)}) + "\n";
    }

    void issue_certificate() {
        const Issued issued = authority_.issue();
        write_file(folder_ / "cert.pem", issued.certificate);
        write_file(folder_ / "key.pem", issued.key);
    }

    static web::Listening in_the_open(const std::string& host = "127.0.0.1", int port = 0) {
        return {.address = {.host = host, .port = port}, .flag = "--metrics-listen", .security = {}};
    }
    web::Listening over_tls() const {
        return {.address = {.host = "0.0.0.0", .port = 0}, .flag = "--metrics-listen", .security = security_};
    }

    static std::vector<web::Route> routes(const std::string& page = "a_total 1\n") {
        return {{.path = "/metrics", .role = access::Role::kAdmin, .get = [page](const web::Request&) {
                     return web::Answer{.content_type = "text/plain; version=0.0.4", .body = page};
                 }}};
    }

    std::string scrape(int port, const std::string& token = "fc_scraper") const {
        const std::string header = token.empty() ? "" : "Authorization: Bearer " + token + "\r\n";
        return https_get(port, "GET /metrics HTTP/1.1\r\n" + header + "\r\n", authority_.certificate());
    }

    const TestFolder folder_;
    const CertificateAuthority authority_;
    access::Gate gate_;
    access::Security security_;
};

} // namespace fieldcast::test
