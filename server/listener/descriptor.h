// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

namespace fieldcast::listener {

/// An open file descriptor, or none; closed by its destructor.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();

    int number() const { return number_; }
    bool is_open() const { return number_ >= 0; }
    int release() { return std::exchange(number_, -1); }

private:
    int number_ = -1;
};

/// Raises this process' limit of descriptors to its hard limit. Returns the limit that is now in effect.
std::size_t raise_descriptor_limit();

/// The limit of descriptors of this process.
std::size_t descriptor_limit();

/// The number of open descriptors.
std::size_t open_descriptors();

/// Number of connections that leaves the server enough descriptors for files, metrics and the device: at most `wanted`,
/// at least one. `limit` and `open`: descriptors of this process before its first connection.
std::size_t affordable_connections(std::size_t wanted, std::size_t limit, std::size_t open);

} // namespace fieldcast::listener
