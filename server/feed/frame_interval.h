// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fieldcast::feed {

/// Time from one frame to the next; at most that of kMinFramesPerSecond, so any number from a peer or a file is safe.
std::chrono::nanoseconds frame_interval(float frames_per_second);

} // namespace fieldcast::feed
