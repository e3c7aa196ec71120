// SPDX-License-Identifier: Apache-2.0
// Where a client takes its token from, and when it does not send it.
#include "client/net/connection.h"
#include "core/base/error.h"
#include "tests/fixtures/test_folder.h"

#include <gmock/gmock.h>

namespace fieldcast::client::net {
namespace {

using test::TestFolder;
using test::write_file;
using testing::HasSubstr;
using testing::Not;

TEST(Access, TakesTheFirstLineThatIsNoComment) {
    const TestFolder folder;
    write_file(folder / "t", "# of alice\n\n  fc_secret \r\nfc_other\n");
    EXPECT_EQ(read_token({.token_file = folder / "t", .token = "fc_environment"}), "fc_secret");
    EXPECT_EQ(read_token({.token = " fc_environment\n"}), "fc_environment");
    EXPECT_EQ(read_token({}), "");
}

TEST(Access, RefusesWhatCannotBeATokenWithoutShowingIt) {
    const TestFolder folder;
    for (const std::string& content : {std::string("two words"), std::string(257, 'x'), std::string("fc_\x01")}) {
        write_file(folder / "t", content);
        try {
            read_token({.token_file = folder / "t"});
            ADD_FAILURE() << content;
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), HasSubstr("--token-file"));
            EXPECT_THAT(error.what(), Not(HasSubstr(content)));
        }
    }
    write_file(folder / "t", "# nothing\n");
    EXPECT_THROW(read_token({.token_file = folder / "t"}), UserError);
    EXPECT_THROW(read_token({.token_file = folder / "absent"}), UserError);
}

TEST(Access, SchemesTurnEncryptionOn) {
    Access access;
    EXPECT_EQ(without_scheme("127.0.0.1:7", access), "127.0.0.1:7");
    EXPECT_EQ(without_scheme("http://host:7", access), "host:7");
    EXPECT_FALSE(access.uses_tls);
    EXPECT_EQ(without_scheme("https://host:7/", access), "host:7");
    EXPECT_TRUE(access.uses_tls);
    Access other;
    EXPECT_EQ(without_scheme("grpcs://[::1]:7", other), "[::1]:7");
    EXPECT_TRUE(other.uses_tls);
    EXPECT_THROW(without_scheme("ftp://host:7", other), UserError);
}

TEST(Access, TokensNeverLeaveTheMachineInPlainText) {
    const Access access{.token = "fc_secret"};
    for (const char* const address : {"127.0.0.1:7", "[::1]:7", "localhost:7", "unix:/tmp/socket"}) {
        EXPECT_NO_THROW(Connection(address, access)) << address;
    }
    for (const char* const address : {"192.168.0.1:7", "example.org:7", "example.org", "dns:///localhost:7"}) {
        EXPECT_THROW(Connection(address, access), UserError) << address;
        EXPECT_NO_THROW(Connection(address, Access{})) << address;
        EXPECT_NO_THROW(Connection(address, Access{.uses_tls = true, .token = "fc_secret"})) << address;
    }
}

TEST(Access, NamesAPemFileThatIsNone) {
    const TestFolder folder;
    write_file(folder / "ca.pem", "hello");
    for (const std::string name : {"ca.pem", "absent.pem"}) {
        try {
            const Connection connection("127.0.0.1:7", {.uses_tls = true, .tls_ca = folder / name});
            ADD_FAILURE() << name;
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), HasSubstr(name));
        }
    }
}

} // namespace
} // namespace fieldcast::client::net
