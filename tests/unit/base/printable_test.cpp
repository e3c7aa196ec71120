// SPDX-License-Identifier: Apache-2.0
#include "core/base/printable.h"

#include "core/base/json_text.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

TEST(Printable, KeepsWhatPeopleWrite) {
    for (const std::string text : {"", "plain", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\xD7\xA9\xD7\x9C"}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, BlanksWhatATerminalObeys) {
    EXPECT_EQ(printable("\x1B[31mred\x1B[0m"), " [31mred [0m");
    EXPECT_EQ(printable(std::string_view("a\0b\r\n\x07\x7F", 7)), "a b    ");
    EXPECT_EQ(printable("a\xC2\x9B" "2Jb"), "a 2Jb");          // CSI as a C1 control
    EXPECT_EQ(printable("\xC2\x80\xC2\x9F\xC2\xA0"), "  \xC2\xA0"); // the last is no control
}

TEST(Printable, BlanksWhatTurnsOrHidesText) {
    EXPECT_EQ(printable("a\xE2\x80\xAEtxt.exe"), "a txt.exe");  // U+202E, override
    EXPECT_EQ(printable("a\xE2\x81\xA6z\xE2\x81\xA9"), "a z "); // U+2066 and U+2069, isolates
    EXPECT_EQ(printable("a\xE2\x80\x8B\xEF\xBB\xBF"), "a  ");   // zero width
    EXPECT_EQ(printable("a\xE2\x80\xA8z"), "a z");              // U+2028, a line separator
    EXPECT_EQ(printable("a\xF3\xA0\x81\x81z"), "a z");          // U+E0041, a tag
}

TEST(Printable, ReplacesBytesThatAreNotUtf8) {
    EXPECT_EQ(printable("a\x9B" "31m"), "a\xEF\xBF\xBD" "31m"); // CSI of an eight-bit terminal
    EXPECT_EQ(printable("\xC3"), "\xEF\xBF\xBD");
}

TEST(Printable, IsBoundedAtTheBorderOfACharacter) {
    EXPECT_EQ(printable(std::string(5000, 'a')).size(), kMaxPrintableBytes);
    EXPECT_EQ(printable("ab\xE2\x82\xAC", 4), "ab");
    EXPECT_EQ(printable(std::string(1000, '\xFF'), 8), "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(JsonText, EscapesWhatATerminalObeys) {
    EXPECT_EQ(json_text("\xC2\x9B\xE2\x80\xAE\xF3\xA0\x81\x81"), R"("\u009b\u202e\udb40\udc41")");
}

} // namespace
} // namespace fieldcast
