// SPDX-License-Identifier: Apache-2.0
// Every input that is kept, through its target: what was found once stays fixed, in builds without libFuzzer too.
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <vector>

namespace fieldcast::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = "tests/fuzz/corpus";

/// Folders whose files are inputs as they are, besides the target's own.
std::vector<fs::path> folders_of(std::string_view target) {
    std::vector<fs::path> folders{kCorpus / target};
    if (target == "strip") {
        folders.insert(folders.end(), {"tests/data/wire/v1", "tests/data/wire/v1/malformed"});
    } else if (target == "gltf") {
        folders.emplace_back("tests/data/malformed_gltf");
    }
    return folders;
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

std::vector<char> bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> target_names() {
    std::vector<std::string> names;
    for (const Target& target : all_targets()) {
        names.emplace_back(target.name);
    }
    return names;
}

class FuzzCorpus : public testing::TestWithParam<std::string> {};

TEST_P(FuzzCorpus, EveryInputIsTaken) {
    // The slowest takes 0.1 s in a release build; libFuzzer's limit per input is 10 s, with sanitizers.
    constexpr std::chrono::seconds kLimit{10};
    std::size_t count = 0;
    for (const fs::path& folder : folders_of(GetParam())) {
        for (const fs::path& file : files_in(folder)) {
            const std::vector<char> bytes = bytes_of(file);
            const auto begin = std::chrono::steady_clock::now();
            EXPECT_NO_THROW(find_target(GetParam())->run(std::as_bytes(std::span(bytes)))) << file;
            EXPECT_LT(std::chrono::steady_clock::now() - begin, kLimit) << file;
            ++count;
        }
    }
    EXPECT_GE(count, 3U) << "inputs to start from";
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(target_names()),
                         [](const auto& test) { return test.param; });

TEST(FuzzCorpusFolder, HoldsAFolderPerTarget) {
    for (const auto& entry : fs::directory_iterator(kCorpus)) {
        EXPECT_NE(find_target(entry.path().filename().string()), nullptr) << entry.path();
    }
}

TEST(FuzzCorpusFolder, IsSmall) {
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kCorpus)) {
        bytes += entry.is_regular_file() ? entry.file_size() : 0;
    }
    EXPECT_LT(bytes, 1U << 20) << "minimise inputs (CONTRIBUTING.md)";
}

} // namespace
} // namespace fieldcast::fuzz
