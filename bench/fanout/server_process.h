// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fieldcast::bench::fanout {

/// A server in a process of its own that writes its port to a file. The destructor ends it.
class ServerProcess {
public:
    /// Removes `port_file`, starts the program and waits for the file. Throws std::runtime_error with the program's
    /// output if it ends before.
    ServerProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& port_file, std::chrono::seconds patience);
    ~ServerProcess();
    ServerProcess(const ServerProcess&) = delete;
    ServerProcess& operator=(const ServerProcess&) = delete;

    int port() const { return port_; }

    /// User and system time of all its threads since its start.
    std::chrono::nanoseconds cpu_time() const;

private:
    bool has_ended();
    void end();

    std::filesystem::path log_;
    pid_t pid_ = -1;
    int port_ = 0;
};

/// Runs a program to its end. Throws std::runtime_error with the program's output if it fails.
void run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& log);

} // namespace fieldcast::bench::fanout
