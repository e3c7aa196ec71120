// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fieldcast::feed {

/// Time from one frame to the next; that of the slowest rate at most, whatever a peer or a file names.
std::chrono::nanoseconds frame_interval(float frames_per_second);

} // namespace fieldcast::feed
