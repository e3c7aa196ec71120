// SPDX-License-Identifier: Apache-2.0
// The server's --config file: same names as the flags, flags win, every mistake with its place.
#include "server/command_line/flags.h"
#include "tests/fixtures/test_folder.h"

#include <gmock/gmock.h>

namespace fieldcast::command_line {
namespace {

using test::TestFolder;
using test::write_file;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A file that exists; tests run in the repository root.
const std::string kScene = "scene = \"CMakeLists.txt\"\n";

class ConfigFile : public testing::Test {
protected:
    Invocation read(const std::string& content, std::vector<std::string> flags = {}) {
        write_file(folder_ / "server.toml", content);
        flags.insert(flags.begin(), {"fieldcast-server", "--config", folder_ / "server.toml"});
        std::vector<const char*> pointers;
        for (const std::string& flag : flags) {
            pointers.push_back(flag.c_str());
        }
        return read_flags(static_cast<int>(pointers.size()), pointers.data());
    }

    std::string at(int line, const std::string& text) const {
        return (folder_ / "server.toml").string() + ":" + std::to_string(line) + ": " + text;
    }

    const TestFolder folder_;
};

TEST_F(ConfigFile, SetsWhatFlagsSet) {
    const Invocation invocation =
        read("channel = [\"a=CMakeLists.txt\", \"b=CMakeLists.txt\"]\nsize = \"320x180\"\n"
             "fps = 12.5\nno-nee = true\nfixed-camera = false\nconvergence = inf\nseed = 7\n");
    EXPECT_THAT(invocation.problems, IsEmpty());
    EXPECT_EQ(invocation.kind, Invocation::Kind::kServe);
    EXPECT_EQ(invocation.config.rendering.channels.size(), 2U);
    EXPECT_EQ(invocation.config.rendering.width_px, 320U);
    EXPECT_EQ(invocation.config.rendering.frames_per_second, 12.5F);
    EXPECT_FALSE(invocation.config.rendering.render.next_event_estimation);
    EXPECT_FALSE(invocation.config.rendering.has_fixed_camera);
    EXPECT_EQ(invocation.config.rendering.seed, 7U);
}

TEST_F(ConfigFile, FlagsWin) {
    const Invocation invocation =
        read(kScene + "fps = 12\nseed = 7\nno-nee = true\n", {"--fps", "3", "--no-nee=false", "--scene", "README.md"});
    EXPECT_THAT(invocation.problems, IsEmpty());
    EXPECT_EQ(invocation.config.rendering.frames_per_second, 3.0F);
    EXPECT_EQ(invocation.config.rendering.seed, 7U);
    EXPECT_TRUE(invocation.config.rendering.render.next_event_estimation);
    ASSERT_EQ(invocation.config.rendering.channels.size(), 1U);
    EXPECT_EQ(invocation.config.rendering.channels[0].name, "README");
}

TEST_F(ConfigFile, ReportsEveryMistakeWithItsPlace) {
    const auto problems =
        read(kScene + "fps = \"many\"\nspp = 0\nsize = \"big\"\nno-nee = 1\nmax-sessions = 5000\n"
                      "traversal = \"magic\"\nseed = -1\nlisten = true\nenvironment = \"absent.exr\"\n")
            .problems;
    EXPECT_THAT(problems, Contains(AllOf(HasSubstr(at(2, "fps")), HasSubstr("many"))));
    EXPECT_THAT(problems, Contains(at(3, "spp 0: 1 to 65536")));
    EXPECT_THAT(problems, Contains(HasSubstr(at(4, "size big: write WIDTHxHEIGHT"))));
    EXPECT_THAT(problems, Contains(at(5, "no-nee: write true or false")));
    EXPECT_THAT(problems, Contains(HasSubstr(at(6, "max-sessions 5000"))));
    EXPECT_THAT(problems, Contains(HasSubstr(at(7, "traversal"))));
    EXPECT_THAT(problems, Contains(HasSubstr(at(8, "seed"))));
    EXPECT_THAT(problems, Contains(HasSubstr(at(9, "listen: needs a value"))));
    EXPECT_THAT(problems, Contains(at(10, "environment absent.exr: there is no such file; or write studio, sky or none")));
    EXPECT_EQ(problems.size(), 9U) << "one each";
}

TEST_F(ConfigFile, SuggestsWhatAnUnknownKeyMayHaveMeant) {
    const auto problems = read(kScene + "sizee = \"8x8\"\nMax-Sessions = 3\nmax_sessions = 3\nzzzzzzzz = 1\n").problems;
    EXPECT_THAT(problems, ElementsAre(at(2, "sizee: there is no such setting; did you mean size?"),
                                      at(3, "Max-Sessions: there is no such setting; did you mean max-sessions?"),
                                      at(4, "max_sessions: there is no such setting; did you mean max-sessions?"),
                                      at(5, "zzzzzzzz: there is no such setting")));
}

TEST_F(ConfigFile, DoesNotDoWhatOnlyTheCommandLineMay) {
    for (const char* const key : {"config", "help", "version", "check-config", "print-config", "make-token"}) {
        EXPECT_THAT(read(kScene + key + " = \"x\"\n").problems, Contains(HasSubstr("no such setting"))) << key;
    }
}

TEST_F(ConfigFile, FlagsKeepTheirNameInProblems) {
    const auto problems = read(kScene + "fps = 12\n", {"--fps", "0"}).problems;
    EXPECT_THAT(problems, ElementsAre(HasSubstr("--fps 0: 0.1 to 240")));
}

TEST_F(ConfigFile, MissingOrBrokenFilesAreProblems) {
    EXPECT_THAT(read("a = = 1\n").problems, Contains(HasSubstr("server.toml:1: ")));
    const std::vector<const char*> flags{"fieldcast-server", "--scene", "CMakeLists.txt", "--config", "/no/such.toml"};
    EXPECT_THAT(read_flags(static_cast<int>(flags.size()), flags.data()).problems,
                ElementsAre("/no/such.toml: cannot be read"));
}

TEST_F(ConfigFile, CheckAndPrintCanBeAskedForBesides) {
    EXPECT_EQ(read(kScene, {"--check-config"}).kind, Invocation::Kind::kCheck);
    const Invocation wrong = read(kScene + "spp = 0\n", {"--print-config"});
    EXPECT_THAT(wrong.problems, testing::SizeIs(1));
    EXPECT_EQ(wrong.text, "");
}

TEST_F(ConfigFile, PrintsWhatIsInForceAndReadsItBack) {
    const std::string content = kScene + "fps = 12\nno-nee = true\nalpha = 0.25\ndevice = \"a \\\"b\\\" \\\\ c\"\n";
    const Invocation printed = read(content, {"--fps", "6", "--time", "1.5", "--print-config"});
    EXPECT_THAT(printed.problems, IsEmpty());
    EXPECT_THAT(printed.text, AllOf(HasSubstr("fps = 6\n"), HasSubstr("no-nee = true\n"), HasSubstr("time = 1.5\n"),
                                    HasSubstr("scene = [\"CMakeLists.txt\"]\n"), Not(HasSubstr("environment"))));
    const Invocation again = read(printed.text, {"--print-config"});
    EXPECT_THAT(again.problems, IsEmpty());
    EXPECT_EQ(again.text, printed.text);
    EXPECT_EQ(again.config.rendering.device, "a \"b\" \\ c");
    EXPECT_EQ(again.config.rendering.render.temporal_alpha, 0.25F);
}

} // namespace
} // namespace fieldcast::command_line
