// SPDX-License-Identifier: Apache-2.0
#include "core/base/toml_file.h"

#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

namespace fieldcast {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Toml : public testing::Test {
protected:
    ~Toml() override { std::filesystem::remove(file_); }

    TomlFile read(const std::string& content) {
        std::ofstream(file_, std::ios::binary) << content;
        return read_toml(file_);
    }

    const std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) / ("toml_file_test_" + std::to_string(::getpid()));
};

TEST_F(Toml, ReadsEveryKindOfValueWithItsLine) {
    const TomlFile file = read("# comment\nsize = \"640x360\"\nfps = 12.5\nspp=4\n\nfar = inf\nfixed = true\n"
                               "scene = [\"a\", 'b']\n");
    EXPECT_THAT(file.problems, IsEmpty());
    ASSERT_EQ(file.entries.size(), 6U);
    EXPECT_EQ(file.entries[0].key, "size");
    EXPECT_THAT(file.entries[0].values, ElementsAre("640x360"));
    EXPECT_EQ(file.entries[0].line, 2);
    EXPECT_THAT(file.entries[1].values, ElementsAre("12.5"));
    EXPECT_THAT(file.entries[2].values, ElementsAre("4"));
    EXPECT_THAT(file.entries[3].values, ElementsAre("inf"));
    EXPECT_TRUE(file.entries[4].is_switch);
    EXPECT_FALSE(file.entries[5].is_switch);
    EXPECT_THAT(file.entries[5].values, ElementsAre("a", "b"));
    EXPECT_EQ(file.entries[5].line, 8);
}

TEST_F(Toml, NumbersReadBackTheSame) {
    const TomlFile file = read("a = 0.1\nb = 1e-300\nc = 9223372036854775807\n");
    EXPECT_EQ(std::stod(file.entries.at(0).values.at(0)), 0.1);
    EXPECT_EQ(std::stod(file.entries.at(1).values.at(0)), 1e-300);
    EXPECT_EQ(file.entries.at(2).values.at(0), "9223372036854775807");
}

TEST_F(Toml, NamesFileAndLineOfWhatItCannotUse) {
    EXPECT_THAT(read("a = 1\nb = = 2\n").problems, ElementsAre(StartsWith(file_.string() + ":2: ")));
    EXPECT_THAT(read("a = 1\na = 2\n").problems, ElementsAre(StartsWith(file_.string() + ":2: ")));
    EXPECT_THAT(read("a = 1\n[limits]\nb = 2\n").problems, ElementsAre(HasSubstr(":2: limits: settings stand at")));
    EXPECT_THAT(read("a = 2020-01-01\nb = [[1]]\nc = 3\n").problems,
                ElementsAre(HasSubstr(":1: a: write"), HasSubstr(":2: b: write")));
}

TEST_F(Toml, IsBounded) {
    EXPECT_THAT(read("a = \"" + std::string(4097, 'x') + "\"").problems, ElementsAre(HasSubstr("4096 bytes")));
    EXPECT_THAT(read("a = \"" + std::string(4096, 'x') + "\"").problems, IsEmpty());
    EXPECT_THAT(read("#" + std::string(1U << 20, 'x')).problems, ElementsAre(HasSubstr("larger than 1 MiB")));
    std::string many = "a = [";
    for (int i = 0; i < 257; ++i) {
        many += "1,";
    }
    EXPECT_THAT(read(many + "]").problems, ElementsAre(HasSubstr("256 of these")));
    EXPECT_THAT(read("a = " + std::string(5000, '[')).problems, testing::SizeIs(1)); // no deep recursion
}

TEST_F(Toml, ReadsTablesWithTheirLines) {
    read("name = \"a\"\n[[group]]\ncount = 2\nlimits = { fps = 3 }\n\n[target]\naddress = \"x\"\n[[group]]\ncount = "
         "4\n");
    const TomlTree tree = read_toml_tree(file_);
    EXPECT_THAT(tree.problems, IsEmpty());
    ASSERT_EQ(tree.root.entries.size(), 1U);
    EXPECT_EQ(tree.root.entries[0].key, "name");
    ASSERT_EQ(tree.root.children.size(), 3U);
    const TomlTable& first = tree.root.children[0];
    EXPECT_EQ(first.name, "group");
    EXPECT_EQ(first.line, 2);
    EXPECT_THAT(first.entries.at(0).values, ElementsAre("2"));
    ASSERT_EQ(first.children.size(), 1U);
    EXPECT_EQ(first.children[0].name, "limits");
    EXPECT_EQ(first.children[0].line, 4);
    EXPECT_THAT(first.children[0].entries.at(0).values, ElementsAre("3"));
    EXPECT_EQ(tree.root.children[1].name, "target");
    EXPECT_EQ(tree.root.children[2].entries.at(0).line, 9);
}

TEST_F(Toml, BoundsTables) {
    read("[a.b.c.d]\nx = 1\n");
    EXPECT_THAT(read_toml_tree(file_).problems, IsEmpty());
    read("[a.b.c.d.e]\nx = 1\n");
    EXPECT_THAT(read_toml_tree(file_).problems, ElementsAre(HasSubstr(":1: e: at most 256 tables, 4 deep")));
    std::string many;
    for (int i = 0; i < 257; ++i) {
        many += "[[a]]\n";
    }
    read(many);
    EXPECT_THAT(read_toml_tree(file_).problems, ElementsAre(HasSubstr("at most 256 tables")));
    read("a = 2020-01-01\n");
    EXPECT_THAT(read_toml_tree(file_).problems, ElementsAre(HasSubstr(":1: a: write")));
}

TEST_F(Toml, SaysWhenAFileCannotBeRead) {
    EXPECT_THAT(read_toml("/no/such/file.toml").problems, ElementsAre("/no/such/file.toml: cannot be read"));
    EXPECT_THAT(read_toml("/").problems, ElementsAre("/: cannot be read"));
}

TEST_F(Toml, QuotesAnyText) {
    const std::string text = "a \"b\" \\c\n\x01 'd' \xC3\xA4";
    const TomlFile file = read("a = " + toml_quoted(text) + "\n");
    EXPECT_THAT(file.problems, IsEmpty());
    EXPECT_THAT(file.entries.at(0).values, ElementsAre(text));
}

} // namespace
} // namespace fieldcast
