// SPDX-License-Identifier: Apache-2.0
#include "core/scene/uri.h"

#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;

TEST(PathOfUri, DecodesAndNormalises) {
    EXPECT_EQ(path_of_uri("a.bin"), "a.bin");
    EXPECT_EQ(path_of_uri("./a//b%20c/%C3%A9.png"), "a/b c/\xC3\xA9.png");
    EXPECT_EQ(path_of_uri("..a/b..c/...d"), "..a/b..c/...d"); // only ".." itself means the parent folder
    EXPECT_EQ(path_of_uri("a/b:c"), "a/b:c");                 // a colon after a slash does not end a scheme
}

TEST(PathOfUri, RefusesWhatLeavesTheFolder) {
    for (const char* uri : {"../a", "a/../b", "a/..", "..", "%2e%2e/a", "a/%2E%2E/b", "a%2F..%2Fb"}) {
        EXPECT_THAT(path_of_uri(uri).error().message, HasSubstr("leaves the scene's folder")) << uri;
    }
    for (const char* uri : {"/etc/passwd", "//host/a", "%2Fetc/passwd", "a\\b", "a%5Cb"}) {
        EXPECT_THAT(path_of_uri(uri).error().message, HasSubstr("absolute path or backslash")) << uri;
    }
    for (const char* uri : {"http://host/a", "file:///etc/passwd", "C:/a", "c%3A/a", "data:x", "./c:a", ".//c%3Aa"}) {
        EXPECT_THAT(path_of_uri(uri).error().message, HasSubstr("scheme")) << uri;
    }
    for (const char* uri : {"", ".", "./", "a%00b", "a%0Ab", "a%", "a%4", "a%zz"}) {
        EXPECT_FALSE(path_of_uri(uri)) << uri;
    }
    EXPECT_FALSE(path_of_uri(std::string(300, 'a')));
    EXPECT_FALSE(path_of_uri(std::string(100'000, '/') + "a"));
}

std::string text_of(std::string_view uri) {
    const auto bytes = decode_data_uri(uri);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "(refused)";
}

TEST(DecodeDataUri, DecodesBase64AndPercent) {
    EXPECT_EQ(text_of("data:application/octet-stream;base64,aGVsbG8="), "hello");
    EXPECT_EQ(text_of("data:;base64,aGk"), "hi"); // padding may be left out
    EXPECT_EQ(text_of("data:text/plain,a%20b"), "a b");
    EXPECT_EQ(text_of("data:;base64,"), "");
}

TEST(DecodeDataUri, RefusesBrokenOnes) {
    for (const char* uri : {"data:;base64", "data:;base64,a", "data:;base64,a*bc", "data:,%4", "date:,a"}) {
        EXPECT_EQ(text_of(uri), "(refused)") << uri;
    }
}

} // namespace
} // namespace fieldcast::scene
