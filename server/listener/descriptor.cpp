// SPDX-License-Identifier: Apache-2.0
#include "server/listener/descriptor.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sys/resource.h>
#include <unistd.h>

namespace fieldcast::listener {

namespace {

/// Descriptors reserved for recordings, callers of /metrics, token files, and occasional needs of gRPC and the driver.
/// At most a quarter of all descriptors is reserved.
constexpr std::size_t kReserve = 64;

} // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor() {
    if (is_open()) {
        ::close(number_);
    }
}

std::size_t raise_descriptor_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
        limit.rlim_cur = limit.rlim_max;
        setrlimit(RLIMIT_NOFILE, &limit); // if that fails, the limit stays unchanged
    }
    return descriptor_limit();
}

std::size_t descriptor_limit() {
    rlimit limit{};
    return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? static_cast<std::size_t>(limit.rlim_cur) : 0;
}

std::size_t open_descriptors() {
    std::error_code error;
    const std::filesystem::directory_iterator files("/proc/self/fd", error);
    return error ? 0 : static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

std::size_t affordable_connections(std::size_t wanted, std::size_t limit, std::size_t open) {
    const std::size_t kept = open + std::min(kReserve, limit / 4);
    return std::clamp<std::size_t>(limit > kept ? limit - kept : 1, 1, std::max<std::size_t>(wanted, 1));
}

} // namespace fieldcast::listener
