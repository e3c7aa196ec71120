// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "server/feed/channel_info.h"
#include "server/recording/record.h"

namespace fieldcast::recording {

/// The content of a recording's first record: `info` with its recorded selections, without the scene bundle.
Bytes to_bytes(const feed::ChannelInfo& info);

/// Decodes the result of `to_bytes`. All values are checked: a replay can serve clients from the result.
Decoded<feed::ChannelInfo> channel_from_bytes(std::span<const std::byte> bytes);

} // namespace fieldcast::recording
