// SPDX-License-Identifier: Apache-2.0
#include "bench/csv.h"

#include "core/base/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <unistd.h>

namespace fieldcast::bench {
namespace {

TEST(Csv, QuotesWhatNeedsIt) {
    EXPECT_EQ(csv_cell("plain; text"), "plain; text");
    EXPECT_EQ(csv_cell("a, b"), "\"a, b\"");
    EXPECT_EQ(csv_cell("say \"go\"\n"), "\"say \"\"go\"\"\n\"");
    EXPECT_EQ(csv_cell(nullptr), "");
    EXPECT_EQ(csv_cell(0.12345678), "0.123457");
    EXPECT_EQ(csv_cell(17), "17");
}

TEST(Csv, RowsFollowTheColumns) {
    const auto file = testing::TempDir() + "csv_test_" + std::to_string(::getpid()) + ".csv";
    write_csv(file, {"first", "second, third", "last"},
              {{{"last", 3}, {"first", "a,b"}, {"ignored", 1}}, {{"second, third", 0.5}, {"last", nullptr}}});
    std::ifstream stream(file);
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    EXPECT_EQ(text, "first,\"second, third\",last\n\"a,b\",,3\n,0.5,\n");
    std::filesystem::remove(file);
}

TEST(Csv, SaysWhichFileCannotBeWritten) {
    try {
        write_csv("no/such/folder/a.csv", {"a"}, {});
        FAIL() << "there is no such folder";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("no/such/folder/a.csv"), std::string::npos);
    }
}

TEST(Csv, RowsBeginWithWhatAllShareAndTheirOwnValuesWin) {
    const auto rows = csv_rows({{"scene", "atelier"}, {"ms", 0}}, {{{"ms", 1}}, {{"ms", 2}, {"bytes", 3}}});
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].dump(), R"({"scene":"atelier","ms":1})");
    EXPECT_EQ(rows[1].dump(), R"({"scene":"atelier","ms":2,"bytes":3})");
}

} // namespace
} // namespace fieldcast::bench
