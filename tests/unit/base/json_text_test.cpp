// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_text.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

TEST(JsonText, KeepsWhatIsUtf8) {
    for (const std::string text : {"", "plain", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\xED\x9F\xBF"}) {
        EXPECT_EQ(json_text(text), '"' + text + '"');
    }
}

TEST(JsonText, EscapesWhatJsonCannotHold) {
    EXPECT_EQ(json_text("a\"b\\c"), R"("a\"b\\c")");
    EXPECT_EQ(json_text(std::string_view("\0\t\x1F\x7F", 4)), R"("\u0000\u0009\u001f\u007f")");
}

TEST(JsonText, ReplacesBytesThatAreNotUtf8) {
    const std::string mark = "\xEF\xBF\xBD";
    EXPECT_EQ(json_text("\xFF"), '"' + mark + '"');
    EXPECT_EQ(json_text("a\xC3"), "\"a" + mark + '"');                               // cut short
    EXPECT_EQ(json_text("\xC0\xAF"), '"' + mark + mark + '"');                       // overlong
    EXPECT_EQ(json_text("\xED\xA0\x80"), '"' + mark + mark + mark + '"');            // a surrogate
    EXPECT_EQ(json_text("\xF4\x90\x80\x80"), '"' + mark + mark + mark + mark + '"'); // beyond U+10FFFF
    EXPECT_EQ(json_text("\xE2\x82z"), '"' + mark + mark + "z\"");
}

} // namespace
} // namespace fieldcast
