// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace fieldcast::client::play {

/// The mode makes its views here, but this machine has no suitable Vulkan device. The message says what the devices
/// lack, and which mode needs none.
class NoDeviceForViews : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace fieldcast::client::play
