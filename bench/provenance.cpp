// SPDX-License-Identifier: Apache-2.0
#include "bench/provenance.h"

#include "bench/commit.h" // made by bench/commit.cmake

#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace fieldcast::bench {

namespace {

/// Model of the processor and number of hardware threads, as Linux reports them.
std::string processor() {
    std::ifstream stream("/proc/cpuinfo");
    std::string model = "unknown processor";
    for (std::string line; std::getline(stream, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            model = line.substr(colon + 2);
            break;
        }
    }
    return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
}

/// The program's own name without its folder, then the arguments; those with spaces in quotes.
std::string command_line() {
    std::ifstream stream("/proc/self/cmdline", std::ios::binary);
    std::string text;
    for (std::string word; std::getline(stream, word, '\0');) {
        if (text.empty()) {
            text = std::filesystem::path(word).filename().string();
        } else {
            const bool is_plain = !word.empty() && word.find_first_of(" \t\n\"'\\") == std::string::npos;
            text += ' ' + (is_plain ? word : '"' + word + '"');
        }
    }
    return text;
}

/// "2025-11-21T08:15Z".
std::string utc_time() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%MZ", &parts);
    return text.data();
}

} // namespace

nlohmann::ordered_json provenance(const gpu::Device& device) {
    return {{"processor", processor()},
            {"device", device.info().name + ", " + device.info().driver},
            {"commit", kCommit},
            {"command", command_line()},
            {"finished", utc_time()}};
}

nlohmann::ordered_json provenance() {
    return {{"processor", processor()}, {"commit", kCommit}, {"command", command_line()}, {"finished", utc_time()}};
}

} // namespace fieldcast::bench
