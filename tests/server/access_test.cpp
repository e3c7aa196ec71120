// SPDX-License-Identifier: Apache-2.0
// Tokens, roles, certificates and the rule about listening, without a server.
#include "core/base/error.h"
#include "server/access/access_watch.h"
#include "server/access/listening_rule.h"
#include "tests/fixtures/certificate_authority.h"
#include "tests/fixtures/test_folder.h"

#include <filesystem>
#include <gmock/gmock.h>
#include <set>

namespace fieldcast::access {
namespace {

using test::CertificateAuthority;
using test::TestFolder;
using test::write_file;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Identity identity_of(const std::string& name, Role role, const std::string& token) {
    return {.name = name, .role = role, .hash = hash_token(token)};
}

std::string bearer(const std::string& token) {
    return "Bearer " + token;
}

/// What a UserError of `run` says.
template <class Run> std::string refusal_of(const Run& run) {
    try {
        run();
    } catch (const UserError& error) {
        return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
}

TEST(Token, HasTwoHundredFiftySixBitsAndIsNeverTheSame) {
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i) {
        tokens.insert(make_token());
    }
    EXPECT_EQ(tokens.size(), 100U);
    for (const std::string& token : tokens) {
        EXPECT_EQ(token.size(), 3U + 43U); // ceil(256 / 6) digits
        EXPECT_EQ(token.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
                  std::string::npos);
    }
}

TEST(Token, HashIsSha256) { // FIPS 180-4, the example "abc"
    EXPECT_EQ(to_hex(hash_token("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(parse_hash(to_hex(hash_token("abc"))), hash_token("abc"));
    EXPECT_TRUE(is_equal(hash_token("abc"), hash_token("abc")));
    EXPECT_FALSE(is_equal(hash_token("abc"), hash_token("abd")));
}

TEST(Token, HashesOfAnyOtherFormAreRefused) {
    const std::string good = to_hex(hash_token("abc"));
    EXPECT_EQ(parse_hash(good.substr(1)), std::nullopt);
    EXPECT_EQ(parse_hash(good + "0"), std::nullopt);
    std::string wrong = good;
    wrong.front() = 'g';
    EXPECT_EQ(parse_hash(wrong), std::nullopt);
}

TEST(TokenList, FindsWhoseTokenItIs) {
    const std::string text = "# people\n\n" + token_line(identity_of("alice", Role::kView, "fc_a")) + "\n  " +
                             token_line(identity_of("bob", Role::kAdmin, "fc_b")) + "\r\n";
    const TokenList list = TokenList::parse(text, "t");
    EXPECT_EQ(list.size(), 2U);
    EXPECT_EQ(list.find("fc_a").value().name, "alice");
    EXPECT_EQ(list.find("fc_b").value().role, Role::kAdmin);
    EXPECT_EQ(list.find("fc_c"), std::nullopt);
    EXPECT_EQ(list.find(""), std::nullopt);
}

TEST(TokenList, NamesFileAndLineOfWhatItCannotRead) {
    const std::string good = token_line(identity_of("alice", Role::kView, "fc_a"));
    const auto refusal = [](const std::string& text) { return refusal_of([&] { TokenList::parse(text, "t.txt"); }); };
    EXPECT_THAT(refusal(good + "\nbob"), StartsWith("t.txt:2: expected NAME ROLE"));
    EXPECT_THAT(refusal("bob boss sha256:00"), StartsWith("t.txt:1: the role must be"));
    EXPECT_THAT(refusal("b/b view sha256:00"), StartsWith("t.txt:1: the name must have"));
    EXPECT_THAT(refusal("bob view sha256:00"), StartsWith("t.txt:1: the third word"));
    EXPECT_THAT(refusal(good + " more"), StartsWith("t.txt:1: expected NAME ROLE"));
    EXPECT_THAT(refusal(good + "\n" + good), StartsWith("t.txt:2: the name 'alice' is in line 1"));
    EXPECT_THAT(refusal(good + "\n" + token_line(identity_of("bob", Role::kView, "fc_a"))),
                StartsWith("t.txt:2: this hash is in line 1"));
}

TEST(TokenList, WithoutLinesNobodyStandsInIt) {
    for (const char* const text : {"", "\n", "# nobody\n"}) {
        EXPECT_EQ(TokenList::parse(text, "t.txt").size(), 0U);
        EXPECT_EQ(TokenList::parse(text, "t.txt").find(""), std::nullopt);
    }
}

TEST(TokenList, LinesWithAMistakeCountForNobodyAndTheOthersStillCount) {
    const TestFolder folder;
    const auto file = folder / "tokens.txt";
    const std::string alice = token_line(identity_of("alice", Role::kView, "fc_a")) + "\n";
    const std::string bob = token_line(identity_of("bob", Role::kView, "fc_b")) + "\n";
    const std::string carol = token_line(identity_of("carol", Role::kView, "fc_c")) + "\n";
    const std::string bob_again = token_line(identity_of("bob", Role::kAdmin, "fc_other")) + "\n";
    write_file(file, alice + "dave view sha256:00\n" + bob + carol + bob_again);
    std::vector<std::string> problems;
    const TokenList list = TokenList::read_good_lines(file, problems);
    EXPECT_THAT(problems, testing::ElementsAre(HasSubstr("tokens.txt:2: the third word"),
                                               HasSubstr("tokens.txt:5: the name 'bob' is in line 3")));
    EXPECT_EQ(list.size(), 2U);
    EXPECT_TRUE(list.find("fc_a").has_value());
    EXPECT_TRUE(list.find("fc_c").has_value());
    EXPECT_EQ(list.find("fc_b"), std::nullopt) << "nobody knows which of the two lines is meant";
    EXPECT_EQ(list.find("fc_other"), std::nullopt);
}

TEST(FileStamp, TellsARewriteOfTheSameSizeWhoseTimeWasSetBack) {
    const TestFolder folder;
    const auto file = folder / "tokens.txt";
    std::ofstream(file) << "one";
    const auto written = std::filesystem::last_write_time(file);
    const FileStamp before = stamp_of(file);
    std::ofstream(file) << "two";
    std::filesystem::last_write_time(file, written);
    EXPECT_EQ(stamp_of(file).modified_ns, before.modified_ns);
    EXPECT_NE(stamp_of(file), before);
}

TEST(TokenList, NeverRepeatsATokenThatStandsThereByMistake) {
    const std::string token = make_token();
    for (const std::string& line : {token, "alice view " + token, token + " view sha256:00", "alice " + token + " x"}) {
        EXPECT_THAT(refusal_of([&] { TokenList::parse(line, "t.txt"); }), Not(HasSubstr(token.substr(3)))) << line;
    }
}

TEST(TokenList, RefusesAFileThatEverybodyMayWrite) {
    const TestFolder folder;
    const auto file = folder / "tokens.txt";
    write_file(file, token_line(identity_of("alice", Role::kView, "fc_a")));
    EXPECT_EQ(TokenList::read(file).size(), 1U);
    std::filesystem::permissions(file, std::filesystem::perms::others_write, std::filesystem::perm_options::add);
    EXPECT_THAT(refusal_of([&] { TokenList::read(file); }), HasSubstr("chmod o-w"));
}

TEST(Gate, WithoutTokensEverybodyMayDoEverything) {
    const Gate gate;
    EXPECT_EQ(gate.admit(std::nullopt, "/any/Method").value().role, Role::kAdmin);
    EXPECT_FALSE(gate.asks_for_tokens());
}

TEST(Gate, AsksForATokenWithTheRightRole) {
    const auto list = [](const char* role) {
        return TokenList::parse("alice " + std::string(role) + " sha256:" + to_hex(hash_token("fc_a")), "t");
    };
    const Gate view(list("view"));
    const Gate steer(list("steer"));
    const Gate admin(list("admin"));
    const char* const open = "/fieldcast.v1.LightField/Open";
    const char* const reflection = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";
    EXPECT_EQ(view.admit(bearer("fc_a"), open).value().name, "alice");
    EXPECT_TRUE(view.admit("bEARER fc_a", "/grpc.health.v1.Health/Check").has_value());
    EXPECT_EQ(view.admit(std::nullopt, open).error().kind, Denial::Kind::kNoToken);
    EXPECT_EQ(view.admit("fc_a", open).error().kind, Denial::Kind::kNoToken);
    EXPECT_EQ(view.admit("Basic fc_a", open).error().kind, Denial::Kind::kNoToken);
    EXPECT_EQ(view.admit(bearer("fc_b"), open).error().kind, Denial::Kind::kUnknownToken);
    EXPECT_EQ(view.admit(bearer("fc_a "), open).error().kind, Denial::Kind::kUnknownToken);
    EXPECT_EQ(view.admit(bearer("fc_a"), reflection).error().kind, Denial::Kind::kRoleTooLow);
    EXPECT_EQ(steer.admit(bearer("fc_a"), reflection).error().kind, Denial::Kind::kRoleTooLow);
    EXPECT_EQ(view.admit(bearer("fc_a"), "/a.Service/OfLaterDays").error().kind, Denial::Kind::kRoleTooLow);
    EXPECT_TRUE(steer.admit(bearer("fc_a"), "steering", Role::kSteer).has_value());
    EXPECT_TRUE(admin.admit(bearer("fc_a"), reflection).has_value());
    EXPECT_THAT(view.admit(bearer("fc_a"), reflection).error().message,
                AllOf(HasSubstr("'alice'"), HasSubstr("view"), HasSubstr("admin")));
}

TEST(Gate, ForgetsReplacedTokens) {
    Gate gate(TokenList::parse("alice view sha256:" + to_hex(hash_token("fc_a")), "t"));
    const Identity before = gate.admit(bearer("fc_a"), "/fieldcast.v1.LightField/Open").value();
    EXPECT_TRUE(gate.is_valid(before));
    gate.replace(TokenList::parse("alice view sha256:" + to_hex(hash_token("fc_new")), "t"));
    EXPECT_FALSE(gate.is_valid(before));
    EXPECT_FALSE(gate.admit(bearer("fc_a"), "/fieldcast.v1.LightField/Open").has_value());
}

TEST(ListeningRule, PlainTextStaysOnLoopback) {
    for (const char* const host : {"127.0.0.1", "127.1.2.3", "[::1]", "localhost"}) {
        EXPECT_EQ(listening_problem(host, {}), std::nullopt) << host;
        EXPECT_EQ(listening_problem(host, {.has_tls = true, .has_tokens = false}), std::nullopt) << host;
    }
    for (const char* const host : {"0.0.0.0", "[::]", "192.168.1.4", "example.org", "[::ffff:127.0.0.1]",
                                   "127.0.0.1.example.org", "", "128.0.0.1"}) {
        EXPECT_THAT(listening_problem(host, {}).value_or(""), HasSubstr("--tls-cert, --tls-key and --tokens")) << host;
        EXPECT_THAT(listening_problem(host, {.has_tls = true, .has_tokens = false}).value_or(""),
                    HasSubstr("--tokens is missing"));
        EXPECT_THAT(listening_problem(host, {.has_tls = false, .has_tokens = true}).value_or(""),
                    HasSubstr("--tls-cert and --tls-key are missing"));
        EXPECT_EQ(listening_problem(host, {.has_tls = true, .has_tokens = true}), std::nullopt);
    }
}

TEST(ListeningRule, OldVersionsOfGrpcDoNotWithstandStrangers) {
    for (const char* const version : {"1.57.0", "1.57", "1.57.0-pre1", "1.60.2", "1.100.0", "2.0.0"}) {
        EXPECT_TRUE(withstands_strangers(version)) << version;
    }
    for (const char* const version : {"1.51.1", "1.56.9", "1.9.100", "0.99.0", "", "1", "1.", "1.x", "v1.60", ".57"}) {
        EXPECT_FALSE(withstands_strangers(version)) << version;
    }
}

TEST(ListeningRule, OldVersionsOfGrpcStayOnLoopbackUnlessTheOperatorAcceptsIt) {
    for (const char* const host : {"0.0.0.0", "[::]", "192.168.1.4", "example.org"}) {
        const std::string problem = exposure_problem(host, "1.51.1", false).value_or("");
        EXPECT_THAT(problem, HasSubstr("gRPC 1.51.1")) << host;
        EXPECT_THAT(problem, HasSubstr("deploy/envoy.yaml")) << host;
        EXPECT_THAT(problem, HasSubstr("--accept-known-grpc-attacks")) << host;
        EXPECT_EQ(exposure_problem(host, "1.51.1", true), std::nullopt) << host;
        EXPECT_EQ(exposure_problem(host, "1.57.0", false), std::nullopt) << host;
    }
    for (const char* const host : {"127.0.0.1", "127.1.2.3", "[::1]", "localhost"}) {
        EXPECT_EQ(exposure_problem(host, "1.51.1", false), std::nullopt) << host;
    }
}

TEST(ListeningRule, TokensInPlainTextOnlyWhereCallersAreChecked) {
    const Protection tokens_only{.has_tls = false, .has_tokens = true};
    EXPECT_EQ(listening_problem("127.0.0.1", tokens_only), std::nullopt);
    EXPECT_EQ(listening_problem("[::1]", tokens_only), std::nullopt);
    EXPECT_TRUE(listening_problem("127.0.0.2", tokens_only).has_value());
}

class Certificate : public testing::Test {
protected:
    /// Writes what was issued and checks it.
    CertificateFacts check(const test::Issued& issued) {
        write_file(files_.certificate, issued.certificate);
        write_file(files_.key, issued.key);
        return check_certificate(files_, std::chrono::system_clock::now());
    }

    const CertificateAuthority authority_;
    const TestFolder folder_;
    CertificateFiles files_{.certificate = folder_ / "cert.pem", .key = folder_ / "key.pem", .client_ca = {}};
};

TEST_F(Certificate, TellsSubjectAndEnd) {
    const CertificateFacts facts = check(authority_.issue({.subject = "render1"}));
    EXPECT_EQ(facts.subject, "CN=render1");
    const std::chrono::duration<double> rest = facts.expires - std::chrono::system_clock::now();
    EXPECT_NEAR(rest.count(), 3600.0, 60.0); // certificates count whole seconds; the rest is for a slow machine
}

TEST_F(Certificate, RefusesWhatClientsWouldRefuse) {
    using std::chrono_literals::operator""h;
    const auto refusal = [&](const test::Issued& issued) { return refusal_of([&] { check(issued); }); };
    const test::Issued good = authority_.issue();
    EXPECT_THAT(refusal({.certificate = good.certificate, .key = authority_.issue().key}),
                AllOf(HasSubstr("key.pem"), HasSubstr("does not belong")));
    EXPECT_THAT(refusal(authority_.issue({.begins = -2h, .ends = -1h})), HasSubstr("expired at"));
    EXPECT_THAT(refusal(authority_.issue({.begins = 1h, .ends = 2h})), HasSubstr("not valid before"));
    EXPECT_THAT(refusal({.certificate = "hello", .key = good.key}), HasSubstr("no certificate"));
    EXPECT_THAT(refusal({.certificate = good.certificate, .key = good.certificate}), HasSubstr("no private key"));
    files_.client_ca = folder_ / "absent.pem";
    EXPECT_THAT(refusal(good), HasSubstr("absent.pem: cannot be read"));
}

} // namespace
} // namespace fieldcast::access
