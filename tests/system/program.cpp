// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include "test_folder.h"

#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace fieldcast::test {

namespace {

using Clock = std::chrono::steady_clock;

/// A child's end and a file's growth have no event that one can wait for with a deadline.
constexpr std::chrono::milliseconds kLookInterval{20};

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

} // namespace

Program::Program(const std::string& file, std::vector<std::string> arguments, std::filesystem::path output,
                 const std::vector<std::string>& environment)
    : output_(std::move(output)) {
    arguments.insert(arguments.begin(), file);
    std::vector<std::string> variables(environment);
    for (char** variable = environ; *variable != nullptr; ++variable) {
        variables.emplace_back(*variable);
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND,
                                     0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    EXPECT_EQ(posix_spawn(&pid_, file.c_str(), &actions, nullptr, pointers_to(arguments).data(),
                          pointers_to(variables).data()),
              0)
        << file;
    posix_spawn_file_actions_destroy(&actions);
}

Program::~Program() {
    if (pid_ > 0 && is_running()) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
}

void Program::send_signal(int signal) const {
    ::kill(pid_, signal);
}

std::optional<int> Program::exit_code(std::chrono::milliseconds patience) {
    const auto deadline = Clock::now() + patience;
    int status = 0;
    while (!exit_code_ && ::waitpid(pid_, &status, WNOHANG) == 0) {
        if (Clock::now() >= deadline) {
            return std::nullopt;
        }
        std::this_thread::sleep_for(kLookInterval);
    }
    if (!exit_code_) {
        exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return exit_code_;
}

std::string Program::text() const {
    return text_of(output_);
}

bool Program::has_said(const std::string& words, std::chrono::milliseconds patience) {
    const auto deadline = Clock::now() + patience;
    while (text().find(words) == std::string::npos) {
        if (!is_running() || Clock::now() >= deadline) {
            return text().find(words) != std::string::npos;
        }
        std::this_thread::sleep_for(kLookInterval);
    }
    return true;
}

} // namespace fieldcast::test
