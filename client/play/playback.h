// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/receiver.h"
#include "client/play/statistics.h"
#include "core/image/light_field_files.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

namespace fieldcast::client::play {

enum class Save : std::uint8_t { kLast, kAll, kNone };

struct PlayOptions {
    ServerOptions server;
    net::Request request;
    std::optional<SteeringOptions> steering{}; ///< moves the camera, too
    std::vector<Change> changes{}; ///< on the running stream, in their order
    std::uint64_t frames = 0; ///< ends after so many shown frames; 0: only on a stop request
    Save save = Save::kLast;
    std::filesystem::path out = "out";
    image::LightFieldProducts products;
    timing::RecorderFiles timing_files;
    // Of modes that make views here:
    std::string device; ///< part of the name; empty: the best
    // Of mode kScene:
    std::filesystem::path cache_folder;
    std::string traversal = "auto"; ///< as in scene::choose_traversal
    std::string visibility = "auto"; ///< as in scene::choose_visibility
};

/// Whether frames of that mode are asked for, at once or by a change.
bool asks_for(const PlayOptions& options, DeliveryMode mode);

/// Whether this machine may have to make views from the scene.
bool needs_scene(const PlayOptions& options);

/// Where a run stands, for a line of text.
struct Progress {
    std::uint64_t shown = 0;
    std::uint64_t wanted = 0; ///< 0: no end
    double frames_per_second = 0.0;
    ShownFrame latest;
};
using OnProgress = std::function<void(const Progress&)>;

struct PlayResult {
    Summary summary;
    std::optional<Failure> failure; ///< empty if all wanted frames were shown, or on a stop request
};

/// There is no Vulkan device for modes that make views here. The message says what was found and what works without
/// one.
class NoDeviceForViews : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Receives frames, makes or takes their views, writes what `options` asks for. Calls `on_progress` after each frame.
/// On a stop request the file being written is finished, and with Save::kLast the last frame is written.
/// Throws UserError, net::NetError, NoDeviceForViews, std::system_error.
PlayResult play(const PlayOptions& options, const OnProgress& on_progress, const std::stop_token& stop);

} // namespace fieldcast::client::play
