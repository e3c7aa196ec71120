// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldcast::command_line {

/// Work of `fieldcast-server inspect`, which describes a glTF file without a device.
struct InspectJob {
    std::filesystem::path file;
    bool as_json = false;
};

/// The description: a text for people, or one JSON object. Throws UserError if the file cannot be opened as a scene.
std::string inspect(const InspectJob& job);

/// The cameras of a glTF file, one per line: the number and name that --camera accepts, field of view, whether it moves.
/// Throws UserError if the file cannot be opened as a scene.
std::string camera_list(const std::filesystem::path& file);

struct InspectInvocation {
    InspectJob job;
    std::string text; ///< not empty: print only this (--help)
    std::vector<std::string> problems;
};

/// Reads the arguments after "inspect".
InspectInvocation read_inspect(std::vector<std::string> arguments);

} // namespace fieldcast::command_line
