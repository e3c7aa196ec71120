// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

namespace fieldcast::test {

/// Passes the time that a frame takes on the device: for renderers that follow a script, and would otherwise make as
/// many frames as the machine can send.
inline void pass_frame_time(std::chrono::nanoseconds time) {
    std::this_thread::sleep_for(time);
}

} // namespace fieldcast::test
