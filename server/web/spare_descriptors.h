// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace fieldcast::web {

/// Reserved descriptors, which can be released when the process has run out of descriptors.
class SpareDescriptors {
public:
    explicit SpareDescriptors(std::size_t count) : count_(count) { refill(); }
    ~SpareDescriptors() { release(); }
    SpareDescriptors(const SpareDescriptors&) = delete;
    SpareDescriptors& operator=(const SpareDescriptors&) = delete;

    bool release(); ///< closes all; false if there were none
    void refill();  ///< reopens as many as possible
    bool is_full() const { return open_.size() == count_; }

private:
    std::size_t count_;
    std::vector<int> open_;
};

} // namespace fieldcast::web
