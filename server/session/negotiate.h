// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/configuration.h"
#include "server/session/limits.h"

#include <memory>
#include <span>
#include <tl/expected.hpp>

namespace fieldcast::session {

/// The channels of a server; never empty. A Configure without a channel name means the first one.
using Channels = std::span<const std::shared_ptr<feed::Feed>>;

/// Chooses a configuration for `asked`, or returns why there is none. Changes nothing: the feed decides on admission.
tl::expected<Configuration, Refusal> negotiate(const v1::Configure& asked, Channels channels, const Limits& limits);

} // namespace fieldcast::session
