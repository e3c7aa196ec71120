// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"

#include "fieldcast/v1/light_field.pb.h"

#include <optional>
#include <string>

// Channels that show a recording have what was recorded and nothing else.
namespace fieldcast::session {

/// `wanted` with what it leaves open set so that the recording has it, if it can be; with other channels: unchanged.
/// Lossy codecs are chosen only where they were asked for, as ever.
v1::Configure narrowed(v1::Configure wanted, const feed::ChannelInfo& channel);

struct RecordedProblem {
    std::string field; ///< of Configure
    std::string message;
};

/// Why `selection` cannot be had, naming what was recorded; nothing if it can.
std::optional<RecordedProblem> recorded_problem(const feed::Selection& selection, const feed::ChannelInfo& channel);

} // namespace fieldcast::session
