// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include "test_folder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <span>
#include <spawn.h>
#include <sys/inotify.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace fieldcast::test {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCannotStart = 127; // as shells say it

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

/// Waits until one of the descriptors is readable. False: none is at `deadline`.
bool wait_for_any(std::span<pollfd> descriptors, Clock::time_point deadline) {
    int ready = 0;
    do {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
        ready = ::poll(descriptors.data(), descriptors.size(),
                       static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    } while (ready < 0 && errno == EINTR);
    return ready > 0;
}

/// Tells when a file is written to.
class FileWatch {
public:
    explicit FileWatch(const std::filesystem::path& file) : descriptor_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
        EXPECT_GE(inotify_add_watch(descriptor_, file.c_str(), IN_MODIFY), 0) << file;
    }
    ~FileWatch() { ::close(descriptor_); }
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    int descriptor() const { return descriptor_; } ///< readable after a write

    /// Forgets what was written until now.
    void reset() const {
        std::array<char, 4096> events{};
        while (::read(descriptor_, events.data(), events.size()) > 0) {
        }
    }

private:
    int descriptor_;
};

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
    const int error = posix_spawn(&pid_, file.c_str(), &actions, nullptr, pointers_to(arguments).data(),
                                  pointers_to(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(error, 0) << file;
    if (error != 0) {
        exit_code_ = kCannotStart;
        return;
    }
    end_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)); // Debian 12's <sys/pidfd.h> is for C only
    EXPECT_GE(end_, 0) << file;
}

Program::~Program() {
    if (is_running()) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    if (end_ >= 0) {
        ::close(end_);
    }
}

void Program::send_signal(int signal) const {
    if (!exit_code_) { // otherwise the number may be somebody else's by now
        ::kill(pid_, signal);
    }
}

std::optional<int> Program::exit_code(std::chrono::milliseconds patience) {
    std::array<pollfd, 1> end{pollfd{.fd = end_, .events = POLLIN, .revents = 0}};
    int status = 0;
    if (!exit_code_ && wait_for_any(end, Clock::now() + patience) && ::waitpid(pid_, &status, 0) == pid_) {
        exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return exit_code_;
}

std::string Program::text() const {
    return text_of(output_);
}

bool Program::has_said(const std::string& words, std::chrono::milliseconds patience) {
    if (exit_code_) {
        return text().find(words) != std::string::npos;
    }
    const auto deadline = Clock::now() + patience;
    const FileWatch watch(output_);
    std::array<pollfd, 2> events{pollfd{.fd = watch.descriptor(), .events = POLLIN, .revents = 0},
                                 pollfd{.fd = end_, .events = POLLIN, .revents = 0}};
    bool goes_on = true;
    while (text().find(words) == std::string::npos) { // what is written from here on is an event
        if (!goes_on) {
            return false;
        }
        goes_on = wait_for_any(events, deadline) && events[1].revents == 0;
        watch.reset();
    }
    return true;
}

} // namespace fieldcast::test
