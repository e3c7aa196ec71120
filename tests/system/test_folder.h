// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <unistd.h>

namespace fieldcast::test {

/// An empty folder of the running test, removed with everything in it.
class TestFolder {
public:
    TestFolder() {
        const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
        const std::string name = std::string(test.test_suite_name()) + "_" + test.name();
        path_ = std::filesystem::path(testing::TempDir()) / (name + "_" + std::to_string(::getpid()));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

/// Replaces the file as a whole: readers see the old content or the new one.
inline void write_file(const std::filesystem::path& file, const std::string& content) {
    std::filesystem::path next = file;
    next += ".next";
    std::ofstream(next, std::ios::binary) << content;
    std::filesystem::rename(next, file);
}

/// Empty if there is no such file.
inline std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace fieldcast::test
