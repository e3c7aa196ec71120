// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/server_process.h"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace fieldcast::bench::fanout {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLookInterval{10}; ///< a file and a child's end have no event with a deadline
constexpr std::chrono::seconds kEndPatience{10};       ///< for draining; then the process is killed
constexpr std::size_t kSaidBytes = 2000;               ///< of a program's output shown in errors

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

pid_t spawn(const std::filesystem::path& program, std::vector<std::string> words, const std::filesystem::path& log) {
    words.insert(words.begin(), program.string());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t pid = -1;
    const int error = posix_spawn(&pid, program.c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        throw std::system_error(error, std::generic_category(), program.string());
    }
    return pid;
}

std::runtime_error failure(const std::filesystem::path& program, const std::filesystem::path& log) {
    const std::string said = text_of(log);
    return std::runtime_error(program.filename().string() + " failed: " +
                              said.substr(said.size() - std::min(said.size(), kSaidBytes)));
}

} // namespace

ServerProcess::ServerProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                             const std::filesystem::path& port_file, std::chrono::seconds patience)
    : log_(port_file.string() + ".log") {
    std::filesystem::remove(port_file);
    pid_ = spawn(program, arguments, log_);
    const auto deadline = Clock::now() + patience;
    for (std::string text; !text.ends_with('\n'); text = text_of(port_file)) {
        if (has_ended() || Clock::now() >= deadline) {
            end();
            throw failure(program, log_);
        }
        std::this_thread::sleep_for(kLookInterval);
    }
    port_ = std::stoi(text_of(port_file));
}

ServerProcess::~ServerProcess() {
    end();
}

bool ServerProcess::has_ended() {
    if (pid_ > 0 && ::waitpid(pid_, nullptr, WNOHANG) == pid_) {
        pid_ = -1;
    }
    return pid_ <= 0;
}

void ServerProcess::end() {
    if (has_ended()) {
        return;
    }
    ::kill(pid_, SIGTERM);
    for (const auto deadline = Clock::now() + kEndPatience; !has_ended() && Clock::now() < deadline;) {
        std::this_thread::sleep_for(kLookInterval);
    }
    if (!has_ended()) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
}

std::chrono::nanoseconds ServerProcess::cpu_time() const {
    clockid_t clock{};
    timespec time{};
    if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &time) != 0) {
        throw std::runtime_error("the server's CPU time cannot be read; has it ended? Its output: " + text_of(log_));
    }
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& log) {
    const pid_t pid = spawn(program, arguments, log);
    int status = 0;
    if (::waitpid(pid, &status, 0) != pid || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        throw failure(program, log);
    }
}

} // namespace fieldcast::bench::fanout
