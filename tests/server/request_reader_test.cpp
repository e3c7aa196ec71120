// SPDX-License-Identifier: Apache-2.0
// What the HTTP edge makes of bytes, without a socket.
#include "server/web/request_reader.h"

#include <gmock/gmock.h>

namespace fieldcast::web {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::optional<ReadRequest> read(std::string_view text, const Limits& limits = {}) {
    RequestReader reader(limits);
    return reader.put(text);
}

/// What the sender of `text` is told; 0: nothing yet, or it is a request.
int refusal(std::string_view text, const Limits& limits = {}) {
    const auto request = read(text, limits);
    return request && !*request ? request->error().status : 0;
}

TEST(RequestReader, ReadsMethodPathAndAuthorization) {
    const auto request = read("GET /metrics?x=1 HTTP/1.1\r\nHost: a\r\nAUTHORIZATION:  Bearer t \r\n\r\n");
    ASSERT_TRUE(request && *request);
    EXPECT_EQ((*request)->method, "GET");
    EXPECT_EQ((*request)->path, "/metrics");
    EXPECT_EQ((*request)->authorization, "Bearer t");
    const auto old = read("GET / HTTP/1.0\r\n\r\n");
    ASSERT_TRUE(old && *old);
    EXPECT_EQ((*old)->authorization, std::nullopt);
}

TEST(RequestReader, ReadsByteByByte) {
    const std::string text = "POST /a HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc";
    RequestReader reader({});
    for (const char byte : text.substr(0, text.size() - 1)) {
        ASSERT_EQ(reader.put({&byte, 1}), std::nullopt);
    }
    const auto request = reader.put("c");
    ASSERT_TRUE(request && *request);
    EXPECT_EQ((*request)->method, "POST");
}

TEST(RequestReader, RefusesWhatIsNoRequest) {
    for (const char* const text :
         {"\r\n\r\n", "GET\r\n\r\n", "GET /\r\n\r\n", "GET / HTTP/2\r\n\r\n", "GET / HTTP/3.0\r\n\r\n",
          " / HTTP/1.1\r\n\r\n", "GET metrics HTTP/1.1\r\n\r\n", "GET http://x/ HTTP/1.1\r\n\r\n",
          "GET / x HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n", "GET / HTTP/1.1\r\n: x\r\n\r\n",
          "GET / HTTP/1.1\r\nAuthorization: a\r\nauthorization: b\r\n\r\n", "GET / HTTP/1.1\n\n",
          "POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n",
          "POST / HTTP/1.1\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n",
          "POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n", "\x16\x03\x01\x02"}) {
        EXPECT_EQ(refusal(text), 400) << text;
    }
    for (const char* const text : {"", "GET", "GET / HTTP/1.1\r\n", "POST / HTTP/1.1\r\nContent-Length: 1\r\n\r\n"}) {
        EXPECT_EQ(read(text), std::nullopt) << text;
    }
}

TEST(RequestReader, HeadsAndBodiesAreBounded) {
    const Limits limits{.head_bytes = 200, .body_bytes = 100};
    const std::string line = "POST / HTTP/1.1\r\n";
    EXPECT_EQ(refusal(line + "a: " + std::string(200, 'x'), limits), 400);
    EXPECT_EQ(refusal(std::string(201, 'x'), limits), 400);
    const auto with_body = [&](int size) {
        return line + "Content-Length: " + std::to_string(size) + "\r\n\r\n" + std::string(100, 'x');
    };
    EXPECT_TRUE(read(with_body(100), limits)->has_value());
    EXPECT_EQ(refusal(with_body(101), limits), 413);
    EXPECT_EQ(refusal(line + "Content-Length: 99999999999\r\n\r\n", limits), 413);
    EXPECT_EQ(refusal(line + "Transfer-Encoding: chunked\r\n\r\n65\r\n" + std::string(101, 'x'), limits), 413);
}

TEST(RequestReader, ChunksWithoutEndAreBounded) {
    const Limits limits;
    RequestReader reader(limits);
    std::optional<ReadRequest> request = reader.put("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n");
    std::size_t sent = 0;
    while (!request && sent < 10 * (limits.head_bytes + limits.body_bytes)) {
        const std::string chunk = "1;" + std::string(500, 'e') + "\r\nx\r\n";
        request = reader.put(chunk);
        sent += chunk.size();
    }
    ASSERT_TRUE(request && !*request);
    EXPECT_LE(sent, limits.head_bytes + limits.body_bytes + 1000);
}

TEST(RequestReader, AnswersCloseTheConnection) {
    const Answer answer{.status = 200, .content_type = "text/x", .body = "abc\n"};
    EXPECT_THAT(text_of(answer, false), AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), HasSubstr("Content-Type: text/x\r\n"),
                                              HasSubstr("Content-Length: 4\r\n"), HasSubstr("Connection: close\r\n"),
                                              EndsWith("\r\n\r\nabc\n")));
    EXPECT_THAT(text_of(answer, true), AllOf(HasSubstr("Content-Length: 4\r\n"), EndsWith("\r\n\r\n")));
    EXPECT_THAT(text_of({.status = 401, .body = ""}, false), HasSubstr("WWW-Authenticate: Bearer\r\n"));
    EXPECT_THAT(text_of({.status = 405, .body = ""}, false), HasSubstr("Allow: GET, HEAD\r\n"));
}

} // namespace
} // namespace fieldcast::web
