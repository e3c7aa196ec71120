// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/client_session.h"
#include "core/timing/timing_recorder.h"

#include <string>

namespace fieldcast::client::play {

/// The record of a decoded frame, with times on our clock. The server's times are unknown before the first exchange of
/// times. `arrived` must still have its content.
timing::DeliveredFrame frame_record(const net::FrameArrived& arrived, const std::string& channel,
                                    std::uint32_t session_number);

/// Writes `record` and, before it, the record of how the server made its frame.
void add_record(timing::TimingRecorder& recorder, timing::DeliveredFrame record);

} // namespace fieldcast::client::play
