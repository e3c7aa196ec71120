// SPDX-License-Identifier: Apache-2.0
// Both programs with TLS and tokens, and what they write down about them: nothing secret.
#include "tests/fixtures/certificate_authority.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"

#include <csignal>
#include <gmock/gmock.h>
#include <sstream>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

constexpr auto kStartPatience = 240s; // a software device under sanitizers on a busy machine
constexpr auto kRunPatience = 60s;

/// A token and the line that makes a server know it.
struct MadeToken {
    std::string token;
    std::string line;
};

class SecurityProcess : public testing::Test {
protected:
    std::string run_server(const std::vector<std::string>& flags, int expected_exit_code) {
        Program server(FIELDCAST_SERVER, flags, folder_ / "run.txt");
        EXPECT_EQ(server.exit_code(kRunPatience), expected_exit_code) << server.text();
        return server.text();
    }

    MadeToken make_token(const std::string& name, const std::string& role) {
        MadeToken made;
        std::istringstream lines(run_server({"--make-token", name, role}, 0));
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("fc_")) {
                made.token = line;
            } else if (!line.starts_with("#")) {
                made.line = line;
            }
        }
        EXPECT_EQ(made.token.size(), 46U);
        EXPECT_THAT(made.line, testing::StartsWith(name + " " + role + " sha256:"));
        return made;
    }

    const TestFolder folder_;
};

TEST_F(SecurityProcess, RefusesToListenBeyondLoopbackAndSaysWhatIsMissing) {
    const std::string said = run_server({"--scene", "scenes/atelier/atelier.gltf", "--listen", "0.0.0.0:50151"}, 2);
    EXPECT_THAT(said, HasSubstr("--listen 0.0.0.0:50151"));
    EXPECT_THAT(said, HasSubstr("--tls-cert, --tls-key and --tokens are missing"));
    EXPECT_THAT(said, HasSubstr("--accept-known-grpc-attacks"));
}

TEST_F(SecurityProcess, MakesTokensForKnownRolesOnly) {
    EXPECT_THAT(run_server({"--make-token", "alice", "boss"}, 2), HasSubstr("view, steer or admin"));
    EXPECT_THAT(run_server({"--make-token", "a/b", "view"}, 2), HasSubstr("letters, digits"));
}

/// A server that listens on all addresses, as protected as that asks for.
class ProtectedServer : public SecurityProcess {
protected:
    void SetUp() override {
        const CertificateAuthority authority;
        issued_ = authority.issue();
        write_file(folder_ / "ca.pem", authority.certificate());
        write_file(folder_ / "cert.pem", issued_.certificate);
        write_file(folder_ / "key.pem", issued_.key);
        made_ = make_token("alice", "view");
        write_file(folder_ / "tokens.txt", made_.line + "\n");
        write_file(folder_ / "alice.txt", "# of alice\n" + made_.token + "\n");
        server_.emplace(FIELDCAST_SERVER,
                        std::vector<std::string>{"--scene", "scenes/atelier/atelier.gltf", "--size", "64x36", "--clock",
                                                 "frames", "--listen", "0.0.0.0:0", "--port-file", folder_ / "port",
                                                 "--accept-known-grpc-attacks",
                                                 "--tls-cert", folder_ / "cert.pem", "--tls-key", folder_ / "key.pem",
                                                 "--tokens", folder_ / "tokens.txt", "--log-level", "debug"},
                        folder_ / "server.log");
        if (!server_->has_said("SERVING", kStartPatience)) {
            ASSERT_THAT(server_->text(), HasSubstr("Vulkan d"));
            GTEST_SKIP() << server_->text();
        }
        port_ = std::to_string(std::stoi(text_of(folder_ / "port")));
    }

    /// Exit code of a client that wants one frame; what it says goes to `said_`.
    int run_client(const std::string& server, std::vector<std::string> flags,
                   const std::vector<std::string>& environment = {}) {
        const std::vector<std::string> always{
            "--server", server,      "--frames", "1",             "--grid", "2x2",
            "--size",   "32x18",     "--verbose", "--out",        folder_ / "out",
            "--json",   folder_ / "report.json"};
        flags.insert(flags.begin(), always.begin(), always.end());
        Program client(FIELDCAST_CLIENT, flags, folder_ / "client.log", environment);
        const std::optional<int> code = client.exit_code(kRunPatience);
        said_ = client.text();
        return code.value_or(-1);
    }

    /// The same for one that cannot get through and need not try for long.
    int run_in_vain(const std::string& server, std::vector<std::string> flags) {
        flags.insert(flags.end(), {"--patience", "3"});
        return run_client(server, flags);
    }

    Issued issued_;
    MadeToken made_;
    std::optional<Program> server_;
    std::string port_;
    std::string said_;
};

TEST_F(ProtectedServer, ServesWhoHasATokenAndWritesNoSecretAnywhere) {
    const std::string ca = folder_ / "ca.pem";
    const std::string token_file = folder_ / "alice.txt";
    const std::string encrypted = "https://localhost:" + port_;
    std::string everything;

    EXPECT_EQ(run_client(encrypted, {"--tls-ca", ca, "--token-file", token_file}), 0) << said_;
    everything += said_ + text_of(folder_ / "report.json");
    EXPECT_EQ(run_client("127.0.0.1:" + port_, {"--tls", "--tls-ca", ca}, {"FIELDCAST_TOKEN=" + made_.token}), 0)
        << said_;
    everything += said_;
    EXPECT_EQ(run_in_vain(encrypted, {"--tls-ca", ca, "--tls-name", "elsewhere", "--token-file", token_file}), 1);
    EXPECT_THAT(said_, HasSubstr("elsewhere"));
    everything += said_;
    EXPECT_EQ(run_client(encrypted, {"--tls-ca", ca}), 2);
    EXPECT_THAT(said_, HasSubstr("--token-file"));
    EXPECT_EQ(run_client(encrypted, {"--tls-ca", ca}, {"FIELDCAST_TOKEN=fc_not_a_known_one"}), 2);
    EXPECT_THAT(said_, HasSubstr("unknown token"));
    everything += said_;
    EXPECT_EQ(run_in_vain(encrypted, {"--token-file", token_file}), 1) << "the system does not trust our authority";
    EXPECT_THAT(said_, HasSubstr("--tls-ca"));
    everything += said_;
    EXPECT_EQ(run_in_vain("127.0.0.1:" + port_, {"--token-file", token_file}), 1) << "a TLS server, asked in plain text";
    EXPECT_THAT(said_, HasSubstr("--tls"));
    everything += said_;
    EXPECT_EQ(run_client("fieldcast.example.org:1", {"--token-file", token_file}), 2);
    EXPECT_THAT(said_, HasSubstr("unencrypted"));
    everything += said_;

    server_->send_signal(SIGTERM);
    EXPECT_EQ(server_->exit_code(kRunPatience), 0);
    const std::string log = server_->text();
    EXPECT_THAT(log, HasSubstr("token=alice"));
    EXPECT_THAT(log, HasSubstr("call denied"));
    everything += log;
    EXPECT_THAT(everything, Not(HasSubstr(made_.token.substr(3))));
    EXPECT_THAT(everything, Not(HasSubstr("fc_not_a_known_one")));
    EXPECT_THAT(everything, Not(HasSubstr("Bearer fc_")));
    EXPECT_THAT(everything, Not(HasSubstr("PRIVATE KEY")));
    std::istringstream key_lines(issued_.key);
    for (std::string line; std::getline(key_lines, line);) {
        EXPECT_THAT(everything, Not(HasSubstr(line)));
    }
}

/// Seconds are what docs/operations.md promises.
TEST_F(ProtectedServer, LetsNobodyInOnceTheTokenFileIsEmptyOrGone) {
    const std::string server = "https://localhost:" + port_;
    const std::vector<std::string> access{"--tls-ca", folder_ / "ca.pem", "--token-file", folder_ / "alice.txt"};
    std::vector<std::string> endless{"--server", server,       "--grid", "2x2",        "--size",
                                     "32x18",    "--patience", "3",      "--save",   "none", "--frames", "0"};
    endless.insert(endless.end(), access.begin(), access.end());
    for (const bool is_deleted : {false, true}) {
        write_file(folder_ / "tokens.txt", made_.line + "\n");
        for (int tries = 0; run_client(server, access) != 0; ++tries) { // until the file is taken up
            ASSERT_LT(tries, 20) << said_;
        }
        Program client(FIELDCAST_CLIENT, endless, folder_ / "endless.log");
        ASSERT_TRUE(client.has_said("frame 1 (id", kRunPatience)) << client.text();
        is_deleted ? static_cast<void>(std::filesystem::remove(folder_ / "tokens.txt"))
                   : write_file(folder_ / "tokens.txt", "");
        EXPECT_EQ(client.exit_code(5s), 2) << client.text();
        EXPECT_THAT(client.text(), HasSubstr("unknown token"));
        EXPECT_EQ(run_client(server, access), 2) << said_;
        EXPECT_THAT(server_->text(),
                    HasSubstr(is_deleted ? "tokens.txt: cannot be read" : "token file without tokens"));
    }
    EXPECT_THAT(server_->text(), HasSubstr("reason=revoked"));
}

TEST_F(SecurityProcess, PrintedConfigurationNamesFilesOnly) {
    const MadeToken made = make_token("alice", "view");
    const Issued issued = CertificateAuthority().issue();
    write_file(folder_ / "cert.pem", issued.certificate);
    write_file(folder_ / "key.pem", issued.key);
    write_file(folder_ / "tokens.txt", made.line + "\n");
    const std::string said =
        run_server({"--scene", "scenes/atelier/atelier.gltf", "--tls-cert", folder_ / "cert.pem", "--tls-key",
                    folder_ / "key.pem", "--tokens", folder_ / "tokens.txt", "--print-config"},
                   0);
    EXPECT_THAT(said, HasSubstr("tokens.txt"));
    EXPECT_THAT(said, Not(HasSubstr(made.line.substr(made.line.find("sha256:")))));
    EXPECT_THAT(said, Not(HasSubstr("BEGIN")));
}

} // namespace
} // namespace fieldcast::test
