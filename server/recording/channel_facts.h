// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "server/feed/channel_info.h"
#include "server/recording/record.h"

namespace fieldcast::recording {

/// `info`, whose `recorded` says what is recorded, as the content of the first record. The bundle is left out.
Bytes to_bytes(const feed::ChannelInfo& info);

/// Everything is checked; a replay of the result can serve clients.
Decoded<feed::ChannelInfo> channel_from_bytes(std::span<const std::byte> bytes);

} // namespace fieldcast::recording
