// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/session.h"
#include "core/timing/recorder.h"

#include <string>

namespace fieldcast::client::play {

/// What is known of a frame when it was decoded, on our clock. The server's times are unknown before the first exchange
/// of times. `arrived` must still hold its content.
timing::DeliveredFrame frame_record(const net::FrameArrived& arrived, const std::string& channel,
                                    std::uint32_t session_number);

/// Writes it, and how its frame was made.
void add_record(timing::Recorder& recorder, timing::DeliveredFrame record);

} // namespace fieldcast::client::play
