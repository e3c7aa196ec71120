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

/// Raises the number of descriptors that this process may have to what it is allowed to raise it to. Returns that.
std::size_t raise_descriptor_limit();

/// How many descriptors this process may have now.
std::size_t descriptor_limit();

/// How many are open.
std::size_t open_descriptors();

/// Connections that leave the server enough descriptors for files, metrics and the device: at most `wanted`, at least
/// one. `limit` and `open`: descriptors of this process, before there is a connection.
std::size_t affordable_connections(std::size_t wanted, std::size_t limit, std::size_t open);

} // namespace fieldcast::listener
