// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldcast::command_line {

/// Tell what is in a glTF file, without a device.
struct InspectJob {
    std::filesystem::path file;
    bool as_json = false;
};

/// What there is to print: for people, or one JSON object. Throws UserError if the file cannot be opened as a scene.
std::string inspect(const InspectJob& job);

struct InspectInvocation {
    InspectJob job;
    std::string text; ///< not empty: only print this (--help)
    std::vector<std::string> problems;
};

/// Reads what stands behind "inspect".
InspectInvocation read_inspect(std::vector<std::string> arguments);

} // namespace fieldcast::command_line
