// SPDX-License-Identifier: Apache-2.0
#include "server/listener/wakeup.h"

#include <cerrno>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace fieldcast::listener {

namespace {

int new_event() {
    const int number = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (number < 0) {
        throw std::system_error(errno, std::generic_category(), "eventfd");
    }
    return number;
}

} // namespace

Wakeup::Wakeup() : event_(new_event()) {}

void Wakeup::stop() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(event_.number(), &one, sizeof one); // full: already stopped
}

Wakeup::Outcome Wakeup::wait(std::span<pollfd> entries, std::chrono::milliseconds patience) const {
    std::vector<pollfd> all(entries.begin(), entries.end());
    all.push_back({.fd = event_.number(), .events = POLLIN, .revents = 0});
    const int count = ::poll(all.data(), all.size(), static_cast<int>(patience.count()));
    for (std::size_t i = 0; i < entries.size(); ++i) {
        entries[i].revents = all[i].revents;
    }
    if (count > 0 && all.back().revents != 0) {
        return Outcome::kStopped; // the event is never read, so it stays set
    }
    return count == 0 ? Outcome::kLate : Outcome::kReady; // interrupted: kReady without a ready entry
}

} // namespace fieldcast::listener
