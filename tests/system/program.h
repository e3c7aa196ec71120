// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fieldcast::test {

/// A program of ours that runs beside the test, with everything it says in a file. Killed if it outlives this object.
class Program {
public:
    /// `environment`: "NAME=value", in addition to the test's own.
    Program(const std::string& file, std::vector<std::string> arguments, std::filesystem::path output,
            const std::vector<std::string>& environment = {});
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void send_signal(int signal) const;
    pid_t pid() const { return pid_; }
    bool is_running() { return !exit_code(std::chrono::milliseconds(0)).has_value(); }

    /// Waits for its end. Nothing if it still runs after `patience`; 128 + signal if one ended it.
    std::optional<int> exit_code(std::chrono::milliseconds patience);

    /// What it has said so far.
    std::string text() const;

    /// Waits until it has said `words`. False: it ended, or `patience` did.
    bool has_said(const std::string& words, std::chrono::milliseconds patience);

private:
    std::filesystem::path output_;
    pid_t pid_ = -1;
    int end_ = -1; ///< a descriptor of the process, readable once it has ended
    std::optional<int> exit_code_;
};

} // namespace fieldcast::test
