// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"

#include "fieldcast/v1/light_field.pb.h"

#include <optional>
#include <string>

// Channels that replay a recording offer only the forms that were recorded.
namespace fieldcast::session {

/// `wanted`, with its open fields set to a recorded form if one fits; unchanged if the channel is not a recording.
/// Lossy codecs are chosen only where the client named them.
v1::Configure narrowed(v1::Configure wanted, const feed::ChannelInfo& channel);

/// Why a recording cannot serve a selection.
struct RecordedProblem {
    std::string field; ///< of Configure
    std::string message; ///< names the recorded forms
};

/// Why the channel cannot serve `selection`; empty: it can, or it is not a recording.
std::optional<RecordedProblem> recorded_problem(const feed::Selection& selection, const feed::ChannelInfo& channel);

} // namespace fieldcast::session
