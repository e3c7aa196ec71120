// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/no_device_for_views.h"
#include "client/play/play_options.h"
#include "client/play/receiver.h"
#include "client/play/statistics.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

namespace fieldcast::client::play {

/// The state of a run, for a progress line.
struct Progress {
    std::uint64_t shown = 0;
    std::uint64_t wanted = 0; ///< 0: unlimited
    double frames_per_second = 0.0;
    ShownFrame latest;
};
using OnProgress = std::function<void(const Progress&)>;

/// The outcome of a run.
struct PlayResult {
    Summary summary;
    std::optional<Failure> failure; ///< empty if all wanted frames were shown, or on a stop request
};

/// Receives frames, makes their views unless they contain them, and writes the files that `options` asks for. Calls
/// `on_progress` after each frame. On a stop request, it completes the current file, and with Save::kLast it writes the
/// last frame.
/// Throws UserError, net::NetError, NoDeviceForViews, std::system_error.
PlayResult play(const PlayOptions& options, const OnProgress& on_progress, const std::stop_token& stop);

} // namespace fieldcast::client::play
