// SPDX-License-Identifier: Apache-2.0
// What strangers type: every mistake is found before anything starts, and told as flag, problem and what to do.
#include "server/command_line/flags.h"
#include "tests/fixtures/test_folder.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fieldcast::command_line {
namespace {

using test::TestFolder;
using test::write_file;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Typos : public testing::Test {
protected:
    /// Of a server with a scene and these flags.
    static std::vector<std::string> problems_of(std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"fieldcast-server", "--scene", "CMakeLists.txt", "--check-config"});
        std::vector<const char*> pointers;
        for (const std::string& flag : flags) {
            pointers.push_back(flag.c_str());
        }
        return read_flags(static_cast<int>(pointers.size()), pointers.data()).problems;
    }

    const TestFolder folder_;
};

TEST_F(Typos, ValuesThatAreNoNumbersAreToldInOurWords) {
    EXPECT_THAT(problems_of({"--max-sessions", "-1"}), ElementsAre("--max-sessions -1: write a whole number, 0 or more"));
    EXPECT_THAT(problems_of({"--max-sessions=many"}), ElementsAre("--max-sessions many: write a whole number, 0 or more"));
    EXPECT_THAT(problems_of({"--max-sessions", "99999999999"}),
                ElementsAre("--max-sessions 99999999999: this number is too large"));
    EXPECT_THAT(problems_of({"--fps", "1,5"}), ElementsAre("--fps 1,5: write a number with a point, such as 0.5"));
    EXPECT_THAT(problems_of({"--time", "1s"}), ElementsAre("--time 1s: write a number with a point, such as 0.5"));
    EXPECT_THAT(problems_of({"--no-nee=maybe"}),
                ElementsAre("--no-nee maybe: write the flag alone, or with =true or =false"));
    EXPECT_THAT(problems_of({"--fps"}), ElementsAre("--fps: needs a value after it"));
    EXPECT_THAT(problems_of({"--fps", "1", "--fps", "2"}), ElementsAre("--fps: is given more than once; give it once"));
    EXPECT_THAT(problems_of({"--make-token", "alice"}), ElementsAre("--make-token: needs 2 values after it"));
}

TEST_F(Typos, OutputFilesThatCannotBeWrittenAreFound) {
    const std::string lost = folder_ / "no/such/file.csv";
    for (const char* const flag : {"--port-file", "--metrics-port-file", "--frame-log", "--record"}) {
        EXPECT_THAT(problems_of({flag, lost}), ElementsAre(std::string(flag) + " " + lost + ": there is no folder " +
                                                           (folder_ / "no/such").string() + "; make it first"));
    }
    const std::string trace = folder_ / "no/such/file.json";
    EXPECT_THAT(problems_of({"--trace", trace}), ElementsAre(HasSubstr("there is no folder")));
    EXPECT_THAT(problems_of({"--record", folder_ / "."}), ElementsAre(HasSubstr("is a folder; name a file in it")));
    EXPECT_THAT(problems_of({"--record", folder_ / "new.fcrec", "--port-file", folder_ / "port"}), IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(folder_ / "new.fcrec")) << "looking at it does not make it";
}

TEST_F(Typos, FoldersThatThisUserMayNotWriteAreFound) {
    constexpr uid_t kNobody = 65534;
    std::filesystem::create_directory(folder_ / "closed");
    ASSERT_EQ(::chmod((folder_ / "closed").c_str(), 0555), 0);
    const bool is_root = ::geteuid() == 0; // who may write everywhere
    ASSERT_TRUE(!is_root || ::seteuid(kNobody) == 0);
    const auto in_closed = problems_of({"--port-file", folder_ / "closed/port"});
    const auto on_closed = problems_of({"--trace", folder_ / "port.json", "--frame-log", folder_ / "closed/log.csv"});
    ASSERT_TRUE(!is_root || ::seteuid(0) == 0);
    EXPECT_THAT(in_closed, ElementsAre(HasSubstr("closed/port: this user may not write to the folder")));
    EXPECT_THAT(on_closed, testing::Contains(HasSubstr("closed/log.csv: this user may not write to the folder")));
}

TEST_F(Typos, OneFileCannotServeTwoFlags) {
    const std::string file = folder_ / "a.fcrec";
    write_file(file, "x");
    EXPECT_THAT(problems_of({"--record", "CMakeLists.txt"}),
                ElementsAre("--record CMakeLists.txt: --scene names the same file; take another one"));
    EXPECT_THAT(problems_of({"--replay", file, "--record", "CMakeLists=" + (folder_ / "./a.fcrec").string()}),
                ElementsAre(HasSubstr("--replay names the same file")));
    EXPECT_THAT(problems_of({"--port-file", folder_ / "port", "--metrics-port-file", folder_ / "port"}),
                ElementsAre(HasSubstr("--port-file names the same file")));
}

TEST_F(Typos, TwoListenersOnOnePortAreFound) {
    const auto with = [&](const char* listen, const char* metrics) {
        return problems_of({"--listen", listen, "--metrics-listen", metrics});
    };
    EXPECT_THAT(with("127.0.0.1:5000", "127.0.0.1:5000"),
                ElementsAre("--metrics-listen 127.0.0.1:5000: --listen has this port, too; take another one"));
    EXPECT_THAT(with("localhost:5000", "127.0.0.1:5000"), ElementsAre(HasSubstr("--listen has this port")));
    EXPECT_THAT(with("127.0.0.1:5000", "127.0.0.1:5001"), IsEmpty());
    EXPECT_THAT(with("127.0.0.1:5000", "[::1]:5000"), IsEmpty());
}

TEST_F(Typos, RecordingsOfViewsThatCannotBeAreFound) {
    const std::string file = folder_ / "a.fcrec";
    EXPECT_THAT(problems_of({"--record", file, "--record-form", "views:9x9"}),
                ElementsAre(testing::AllOf(HasSubstr("--record-form views:9x9: "), HasSubstr("72"))));
    EXPECT_THAT(problems_of({"--record", file, "--record-form", "views:0x3"}),
                ElementsAre(HasSubstr("--record-form views:0x3: ")));
    EXPECT_THAT(problems_of({"--record", file, "--record-form", "views:3x3:9000x20"}),
                ElementsAre(HasSubstr("--record-form 9000x20: ")));
    EXPECT_THAT(problems_of({"--record", file, "--record-form", "views:8x9"}), IsEmpty());
}

TEST_F(Typos, AFileThatIsNoTomlIsTheOnlyProblem) {
    write_file(folder_ / "server.toml", "scene = a.gltf\n");
    const std::string file = folder_ / "server.toml";
    const std::vector<const char*> flags{"fieldcast-server", "--config", file.c_str(), "--check-config"};
    const auto problems = read_flags(static_cast<int>(flags.size()), flags.data()).problems;
    EXPECT_THAT(problems, ElementsAre(testing::StartsWith(file + ":1: ")));
    EXPECT_THAT(problems, Not(testing::Contains(HasSubstr("no scene given"))));
}

} // namespace
} // namespace fieldcast::command_line
