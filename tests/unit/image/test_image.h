// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>

namespace fieldcast::test {

inline std::vector<std::byte> file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in) << file << " cannot be read";
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

/// An image of `tests/unit/image/data`.
inline std::vector<std::byte> image_bytes(const std::string& name) {
    return file_bytes(std::filesystem::path("tests/unit/image/data") / name);
}

/// An empty folder of one test case, removed at its end.
class TestFolder {
public:
    TestFolder() {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        const std::string name = std::string(info->test_suite_name()) + "." + info->name();
        path_ = std::filesystem::path(testing::TempDir()) / (name + "." + std::to_string(::getpid())); // others run too
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
    }

private:
    std::filesystem::path path_;
};

/// A number in 0 … 255 that looks random, the same on every machine.
inline std::uint32_t hash_byte(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    std::uint32_t v = x * 73856093U ^ y * 19349663U ^ channel * 83492791U ^ 2654435761U;
    v = (v ^ v >> 15) * 2246822519U;
    v = (v ^ v >> 13) * 3266489917U;
    return (v ^ v >> 16) >> 24;
}

/// A kRgb8 plane of one colour.
inline Plane flat_plane(std::uint32_t width_px, std::uint32_t height_px, std::uint8_t r, std::uint8_t g,
                        std::uint8_t b) {
    Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, width_px, height_px, {}};
    const std::byte colour[3]{std::byte{r}, std::byte{g}, std::byte{b}};
    plane.bytes.resize(plane_bytes(plane.format, width_px, height_px));
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        plane.bytes[i] = colour[i % 3];
    }
    return plane;
}

} // namespace fieldcast::test
