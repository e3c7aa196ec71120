// SPDX-License-Identifier: Apache-2.0
// TLS, certificates of clients, tokens and their replacement, against a server with a synthetic channel.
#include "core/base/error.h"
#include "core/base/log.h"
#include "server/access/listening_rule.h"
#include "server/service/grpc_server.h"
#include "server/service/grpc_version.h"
#include "tests/fixtures/certificate_authority.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/server_client.h"
#include "tests/server/session_count.h"
#include "tests/server/synthetic.h"

#include <gmock/gmock.h>
#include <thread>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;
using Kind = v1::ServerMessage;

constexpr const char* kHealthCheck = "/grpc.health.v1.Health/Check";
constexpr const char* kReflection = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";
constexpr const char* kListServices = "\x3A\x01*"; // ServerReflectionRequest.list_services = "*"
constexpr const char* kServing = "\x08\x01";       // HealthCheckResponse.status = SERVING
constexpr auto kRefusalPatience = 2s; // handshakes take milliseconds; a refused one is tried again until then
constexpr auto kReloadPatience = 20s; // files are looked at once a second
constexpr auto kRevocationBound = 5s; // docs/operations.md promises it

std::string line(const std::string& name, access::Role role, const std::string& token) {
    return access::token_line({.name = name, .role = role, .hash = access::hash_token(token)}) + "\n";
}

session::Limits quick_limits() {
    session::Limits limits;
    limits.going_away_deadline = 500ms;
    return limits;
}

class Security : public testing::Test {
protected:
    Security() {
        issue(authority_);
        write_file(folder_ / "tokens.txt",
                   line("viewer", access::Role::kView, viewer_) + line("operator", access::Role::kAdmin, operator_));
    }

    void issue(const CertificateAuthority& authority) {
        const Issued issued = authority.issue();
        write_file(folder_ / "key.pem", issued.key);
        write_file(folder_ / "cert.pem", issued.certificate);
    }

    access::Security tls() const {
        return {.certificates = access::CertificateFiles{.certificate = folder_ / "cert.pem",
                                                         .key = folder_ / "key.pem",
                                                         .client_ca = std::nullopt},
                .tokens = std::nullopt};
    }

    access::Security tls_and_tokens() const {
        access::Security security = tls();
        security.tokens = folder_ / "tokens.txt";
        return security;
    }

    std::unique_ptr<service::GrpcServer> serve(const access::Security& security) {
        return std::make_unique<service::GrpcServer>(HostPort{.host = "127.0.0.1", .port = 0},
                                                     std::vector{channel_.feed()}, quick_limits(), security);
    }

    static std::shared_ptr<grpc::ChannelCredentials> trusting(const CertificateAuthority& authority,
                                                              const Issued& own = {}) {
        return grpc::SslCredentials(
            {.pem_root_certs = authority.certificate(), .pem_private_key = own.key, .pem_cert_chain = own.certificate});
    }

    /// Of a ListChannels over a new connection.
    static grpc::Status status_of(int port, const std::shared_ptr<grpc::ChannelCredentials>& credentials,
                                  const std::string& token = "", std::chrono::seconds patience = kCallDeadline) {
        grpc::ClientContext context;
        context.set_wait_for_ready(true);
        context.set_deadline(std::chrono::system_clock::now() + patience);
        if (!token.empty()) {
            context.AddMetadata("authorization", "Bearer " + token);
        }
        v1::ListChannelsResponse response;
        return v1::Catalog::NewStub(connect(port, credentials))->ListChannels(&context, {}, &response);
    }

    /// Whether calls with `token` come to end like that: a change of the token file has no event to wait for.
    bool comes_to_status(const service::GrpcServer& server, const std::string& token, StatusCode wanted) const {
        return comes_true(
            [&] { return status_of(server.port(), trusting(authority_), token).error_code() == wanted; },
            kReloadPatience);
    }

    const TestFolder folder_;
    const CertificateAuthority authority_;
    const std::string viewer_ = access::make_token();
    const std::string operator_ = access::make_token();
    SyntheticChannel channel_;
};

TEST_F(Security, NobodyListensBeyondLoopbackUnprotected) {
    access::Security tokens_only;
    tokens_only.tokens = folder_ / "tokens.txt";
    for (const access::Security& security : {access::Security{}, tls(), tokens_only}) {
        EXPECT_THROW(service::GrpcServer({.host = "0.0.0.0", .port = 0}, {channel_.feed()}, quick_limits(), security),
                     UserError);
    }
    access::Security accepting = tls_and_tokens();
    accepting.accepts_known_attacks = true;
    const service::GrpcServer open({.host = "0.0.0.0", .port = 0}, {channel_.feed()}, quick_limits(), accepting);
    EXPECT_TRUE(status_of(open.port(), trusting(authority_), viewer_).ok());
}

TEST_F(Security, AnOldGrpcDoesNotMeetStrangersUnasked) {
    if (access::withstands_strangers(service::grpc_version())) {
        const service::GrpcServer open({.host = "0.0.0.0", .port = 0}, {channel_.feed()}, quick_limits(),
                                       tls_and_tokens());
        EXPECT_NE(open.port(), 0);
        return;
    }
    try {
        const service::GrpcServer open({.host = "0.0.0.0", .port = 0}, {channel_.feed()}, quick_limits(),
                                       tls_and_tokens());
        FAIL() << "it listens";
    } catch (const UserError& problem) {
        EXPECT_THAT(problem.what(), HasSubstr("gRPC " + service::grpc_version()));
    }
}

TEST_F(Security, SendsFramesEncryptedToWhoeverShowsAToken) {
    const auto server = serve(tls_and_tokens());
    OpenCall call(connect(server->port(), trusting(authority_)), viewer_);
    call.configure();
    EXPECT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Security, HearsItselfHoweverItIsProtected) {
    const CertificateAuthority clients;
    write_file(folder_ / "clients.pem", clients.certificate());
    access::Security mutual = tls_and_tokens();
    mutual.certificates->client_ca = folder_ / "clients.pem";
    access::Security tokens_only;
    tokens_only.tokens = folder_ / "tokens.txt";
    session::Limits limits = quick_limits();
    limits.probe_interval = 1ms;
    for (const access::Security& security : {tls(), tls_and_tokens(), mutual, tokens_only}) {
        const auto registry = std::make_shared<metrics::Registry>();
        const service::GrpcServer server({.host = "localhost", .port = 0}, {channel_.feed()}, limits, security,
                                         {.registry = registry});
        std::string page;
        for (const auto deadline = Clock::now() + kReloadPatience; Clock::now() < deadline;) {
            page = registry->page().text();
            if (page.find("fieldcast_self_probe_answers_total 0\n") == std::string::npos) {
                break;
            }
        }
        EXPECT_THAT(page, Not(HasSubstr("fieldcast_self_probe_answers_total 0\n")));
        EXPECT_THAT(page, HasSubstr("fieldcast_self_probe_failures_total 0\n"));
        EXPECT_THAT(page, HasSubstr("fieldcast_serving 1\n"));
    }
}

TEST_F(Security, EveryServiceAsksForAToken) {
    const auto server = serve(tls_and_tokens());
    const auto connection = connect(server->port(), trusting(authority_));
    std::string answer;
    for (const char* const token : {"", "fc_wrong"}) {
        EXPECT_EQ(OpenCall(connection, token).finish().error_code(), StatusCode::UNAUTHENTICATED);
        EXPECT_EQ(call_raw(*connection, kHealthCheck, "", answer, token).error_code(), StatusCode::UNAUTHENTICATED);
        EXPECT_EQ(exchange_raw(*connection, kReflection, kListServices, answer, token).error_code(),
                  StatusCode::UNAUTHENTICATED);
        EXPECT_EQ(status_of(server->port(), trusting(authority_), token).error_code(), StatusCode::UNAUTHENTICATED);
    }
    EXPECT_EQ(answer, "");
    EXPECT_THAT(OpenCall(connection).finish().error_message(), HasSubstr("--token-file"));
    EXPECT_EQ(server->session_count(), 0U);
}

TEST_F(Security, RolesSayWhatATokenOpens) {
    const auto server = serve(tls_and_tokens());
    const auto connection = connect(server->port(), trusting(authority_));
    std::string answer;
    EXPECT_TRUE(call_raw(*connection, kHealthCheck, "", answer, viewer_).ok());
    EXPECT_EQ(answer, kServing);
    const grpc::Status forbidden = exchange_raw(*connection, kReflection, kListServices, answer, viewer_);
    EXPECT_EQ(forbidden.error_code(), StatusCode::PERMISSION_DENIED);
    EXPECT_THAT(forbidden.error_message(), HasSubstr("'viewer' has the role view"));
    EXPECT_TRUE(exchange_raw(*connection, kReflection, kListServices, answer, operator_).ok());
    EXPECT_THAT(answer, HasSubstr("fieldcast.v1.LightField"));
}

TEST_F(Security, TokensWorkInPlainTextOnLoopback) {
    access::Security security;
    security.tokens = folder_ / "tokens.txt";
    const auto server = serve(security);
    EXPECT_TRUE(status_of(server->port(), grpc::InsecureChannelCredentials(), viewer_).ok());
    EXPECT_EQ(status_of(server->port(), grpc::InsecureChannelCredentials()).error_code(), StatusCode::UNAUTHENTICATED);
    std::string answer;
    EXPECT_TRUE(call_raw(*connect(server->port()), "/grpc.health.v1.Health/Check", "", answer).ok())
        << "supervisors and proxies of this machine need no token";
}

TEST_F(Security, StrangersCannotShakeHands) {
    const auto server = serve(tls_and_tokens());
    const CertificateAuthority other;
    EXPECT_FALSE(status_of(server->port(), grpc::InsecureChannelCredentials(), viewer_, kRefusalPatience).ok());
    EXPECT_FALSE(status_of(server->port(), trusting(other), viewer_, kRefusalPatience).ok());
    EXPECT_TRUE(status_of(server->port(), trusting(authority_), viewer_).ok());
}

TEST_F(Security, ClientsShowACertificateWhenAsked) {
    const CertificateAuthority clients;
    write_file(folder_ / "clients.pem", clients.certificate());
    access::Security security = tls_and_tokens();
    security.certificates->client_ca = folder_ / "clients.pem";
    const auto server = serve(security);
    const auto attempt = [&](const Issued& own, const std::string& token, std::chrono::seconds patience) {
        return status_of(server->port(), trusting(authority_, own), token, patience);
    };
    EXPECT_TRUE(attempt(clients.issue(), viewer_, kCallDeadline).ok());
    EXPECT_EQ(attempt(clients.issue(), "", kCallDeadline).error_code(), StatusCode::UNAUTHENTICATED);
    EXPECT_FALSE(attempt({}, viewer_, kRefusalPatience).ok());
    EXPECT_FALSE(attempt(authority_.issue(), viewer_, kRefusalPatience).ok()) << "signed by somebody else";
}

TEST_F(Security, TakesUpARenewedCertificate) {
    const auto server = serve(tls());
    ASSERT_TRUE(status_of(server->port(), trusting(authority_)).ok());
    const CertificateAuthority successor;
    issue(successor);
    EXPECT_TRUE(status_of(server->port(), trusting(successor), "", kReloadPatience).ok());
    EXPECT_FALSE(status_of(server->port(), trusting(authority_), "", kRefusalPatience).ok());
}

TEST_F(Security, RevokedTokensEndTheirSessions) {
    const auto server = serve(tls_and_tokens());
    OpenCall stays(connect(server->port(), trusting(authority_)), operator_);
    OpenCall leaves(connect(server->port(), trusting(authority_)), viewer_);
    stays.configure();
    leaves.configure();
    ASSERT_TRUE(stays.read_until(Kind::kConfigured).has_value());
    ASSERT_TRUE(leaves.read_until(Kind::kConfigured).has_value());
    const std::string successor = access::make_token();
    write_file(folder_ / "tokens.txt",
               line("viewer", access::Role::kView, successor) + line("operator", access::Role::kAdmin, operator_));
    const auto going_away = leaves.read_until(Kind::kGoingAway);
    ASSERT_TRUE(going_away.has_value());
    EXPECT_THAT(going_away->going_away().reason(), HasSubstr("revoked"));
    EXPECT_EQ(leaves.finish().error_code(), StatusCode::DEADLINE_EXCEEDED) << "it did not half-close";
    EXPECT_EQ(status_of(server->port(), trusting(authority_), viewer_).error_code(), StatusCode::UNAUTHENTICATED);
    EXPECT_TRUE(status_of(server->port(), trusting(authority_), successor).ok());
    EXPECT_TRUE(test::comes_to_sessions(*server, 1));
    stays.half_close();
    EXPECT_TRUE(stays.finish().ok());
}

TEST_F(Security, EmptyTokenFileAtTheStartMeansNobody) {
    write_file(folder_ / "tokens.txt", "# nobody yet\n");
    const auto server = serve(tls_and_tokens());
    EXPECT_EQ(status_of(server->port(), trusting(authority_), viewer_).error_code(), StatusCode::UNAUTHENTICATED);
    write_file(folder_ / "tokens.txt", line("viewer", access::Role::kView, viewer_));
    EXPECT_TRUE(comes_to_status(*server, viewer_, StatusCode::OK));
}

/// What may happen to a token file, and who may call then.
struct Fate {
    const char* name;
    void (*befall)(const std::filesystem::path& file);
    const char* logged;
};

class FatefulTokens : public Security, public testing::WithParamInterface<Fate> {};

INSTANTIATE_TEST_SUITE_P(
    All, FatefulTokens,
    testing::Values(Fate{"LastLineDeleted", [](const auto& file) { write_file(file, ""); }, "all calls are denied"},
                    Fate{"Truncated", [](const auto& file) { std::ofstream{file}; }, "all calls are denied"},
                    Fate{"FileDeleted", [](const auto& file) { std::filesystem::remove(file); }, "cannot be read"},
                    Fate{"Folder",
                         [](const auto& file) {
                             std::filesystem::remove(file);
                             std::filesystem::create_directory(file);
                         },
                         "cannot be read"},
                    Fate{"WritableByAll",
                         [](const auto& file) {
                             using std::filesystem::perms;
                             std::filesystem::permissions(file, perms::others_write,
                                                          std::filesystem::perm_options::add);
                         },
                         "chmod o-w"},
                    Fate{"TooLarge", [](const auto& file) { write_file(file, std::string(2U << 20, '#')); },
                         "is larger than"},
                    Fate{"Garbled", [](const auto& file) { write_file(file, "\x1B\x7F\xFF garbled\n"); },
                         "tokens.txt:1"}),
    [](const auto& fate) { return fate.param.name; });

TEST_P(FatefulTokens, LeaveNobodyInAndAreLogged) {
    const auto server = serve(tls_and_tokens());
    OpenCall leaves(connect(server->port(), trusting(authority_)), viewer_);
    leaves.configure();
    ASSERT_TRUE(leaves.read_until(Kind::kConfigured).has_value());
    testing::internal::CaptureStderr();
    const auto before = Clock::now();
    GetParam().befall(folder_ / "tokens.txt");
    leaves.finish();
    EXPECT_LE(Clock::now() - before, kRevocationBound);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr(GetParam().logged));
    EXPECT_EQ(status_of(server->port(), trusting(authority_), viewer_).error_code(), StatusCode::UNAUTHENTICATED);
    std::filesystem::remove_all(folder_ / "tokens.txt");
    write_file(folder_ / "tokens.txt", line("viewer", access::Role::kView, viewer_));
    EXPECT_TRUE(comes_to_status(*server, viewer_, StatusCode::OK)) << "mended";
}

TEST_F(Security, RevokedSessionsEndThoughTheyReadNothing) {
    access::Security security;
    security.tokens = folder_ / "tokens.txt";
    const auto server = serve(security);
    OpenCall silent(connect_with_small_window(server->port()), viewer_);
    v1::Configure wanted; // views as they are: more than a small window takes in
    v1::CodecPreference& preference = *wanted.add_codecs();
    preference.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
    preference.add_codecs(v1::CODEC_RAW);
    silent.configure(wanted);
    ASSERT_TRUE(silent.read_until(Kind::kConfigured).has_value()); // from here on, nothing is read
    const auto before = Clock::now();
    std::filesystem::remove(folder_ / "tokens.txt");
    EXPECT_TRUE(test::comes_to_sessions(*server, 0));
    EXPECT_LE(Clock::now() - before, kRevocationBound);
}

TEST_F(Security, DamagedLineCountsForNobodyAndTheOthersStay) {
    testing::internal::CaptureStderr();
    const auto server = serve(tls_and_tokens());
    write_file(folder_ / "tokens.txt",
               "viewer view " + viewer_ + "\n" + // the token itself, by mistake
                   line("operator", access::Role::kAdmin, operator_));
    EXPECT_TRUE(comes_to_status(*server, viewer_, StatusCode::UNAUTHENTICATED));
    EXPECT_TRUE(status_of(server->port(), trusting(authority_), operator_).ok());
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_THAT(log, HasSubstr("line of the token file ignored"));
    EXPECT_THAT(log, HasSubstr("tokens.txt:1"));
    EXPECT_THAT(log, Not(HasSubstr(viewer_)));
}

} // namespace
} // namespace fieldcast::test
