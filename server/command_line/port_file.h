// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace fieldcast::command_line {

/// A file with the port number. It appears with its full content, and is removed on destruction.
class PortFile {
public:
    /// Throws UserError if it cannot be written.
    PortFile(std::filesystem::path file, int port);
    ~PortFile();
    PortFile(const PortFile&) = delete;
    PortFile& operator=(const PortFile&) = delete;

private:
    std::filesystem::path file_;
};

} // namespace fieldcast::command_line
