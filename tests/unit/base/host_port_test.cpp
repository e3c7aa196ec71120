// SPDX-License-Identifier: Apache-2.0
#include "core/base/host_port.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

TEST(HostPort, ReadsNamesAndAddresses) {
    EXPECT_EQ(parse_host_port("localhost:80"), (HostPort{.host = "localhost", .port = 80}));
    EXPECT_EQ(parse_host_port("127.0.0.1:0"), (HostPort{.host = "127.0.0.1", .port = 0}));
    EXPECT_EQ(parse_host_port("[::1]:65535"), (HostPort{.host = "[::1]", .port = 65535}));
    EXPECT_EQ(to_text({.host = "[::1]", .port = 7}), "[::1]:7");
}

TEST(HostPort, RefusesEverythingElse) {
    for (const char* const text : {"", ":", "host", "host:", ":80", "host:65536", "host:-1", "host:+1", "host:80x",
                                   "host: 80", "::1:80", "fe80::1:80", "host:99999999999"}) {
        EXPECT_EQ(parse_host_port(text), std::nullopt) << text;
    }
    EXPECT_EQ(parse_host_port(std::string(256, 'a') + ":80"), std::nullopt);
}

TEST(HostPort, KnowsLoopbackWithoutAskingAnyone) {
    for (const char* const host : {"127.0.0.1", "127.255.0.9", "[::1]", "localhost"}) {
        EXPECT_TRUE(is_loopback(host)) << host;
    }
    for (const char* const host : {"0.0.0.0", "128.0.0.1", "[::]", "::1", "localhost.example.org", "127.0.0.1.nip.io",
                                   "[::ffff:127.0.0.1]", "2130706433", ""}) {
        EXPECT_FALSE(is_loopback(host)) << host;
    }
}

} // namespace
} // namespace fieldcast
