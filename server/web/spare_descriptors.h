// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace fieldcast::web {

/// Descriptors that are open for nothing, so that there are some left when the process has run out of them.
class SpareDescriptors {
public:
    explicit SpareDescriptors(std::size_t count) : count_(count) { refill(); }
    ~SpareDescriptors() { release(); }
    SpareDescriptors(const SpareDescriptors&) = delete;
    SpareDescriptors& operator=(const SpareDescriptors&) = delete;

    bool release(); ///< gives all back; false if there were none
    void refill();  ///< as far as the process may open some
    bool is_full() const { return open_.size() == count_; }

private:
    std::size_t count_;
    std::vector<int> open_;
};

} // namespace fieldcast::web
