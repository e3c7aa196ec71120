// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/port_file.h"

#include "core/base/error.h"

#include <fstream>
#include <unistd.h>

namespace fieldcast::command_line {

PortFile::PortFile(std::filesystem::path file, int port) : file_(std::move(file)) {
    std::filesystem::path unfinished = file_;
    unfinished += ".";
    unfinished += std::to_string(getpid());
    std::ofstream stream(unfinished);
    stream << port << '\n';
    stream.close();
    std::error_code error;
    if (stream) {
        std::filesystem::rename(unfinished, file_, error);
    }
    if (!stream || error) {
        std::filesystem::remove(unfinished, error);
        throw UserError("--port-file " + file_.string() + ": cannot be written");
    }
}

PortFile::~PortFile() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

} // namespace fieldcast::command_line
