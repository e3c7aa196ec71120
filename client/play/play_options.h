// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/change.h"
#include "client/play/pilot.h"
#include "client/play/server_options.h"
#include "core/image/light_field_files.h"
#include "core/timing/timing_recorder.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::client::play {

/// Which frames are written to files.
enum class Save : std::uint8_t { kLast, kAll, kNone };

/// Options of play().
struct PlayOptions {
    ServerOptions server;
    net::Request request;
    std::optional<SteeringOptions> steering{}; ///< set: this client also moves the camera
    std::vector<Change> changes{};             ///< of the running stream, in their order
    std::uint64_t frames = 0;                  ///< number of frames to show; 0: until a stop request
    Save save = Save::kLast;
    std::filesystem::path out = "out";
    image::LightFieldProducts products;
    timing::TimingFiles timing_files;
    // For modes in which the client makes the views:
    std::string device; ///< part of the device's name; empty: the best device
    // For modes that need the scene:
    std::filesystem::path cache_folder;
    std::string traversal = "auto";  ///< as in scene::choose_traversal
    std::string visibility = "auto"; ///< as in scene::choose_visibility
};

/// Whether the request or a change asks for frames of that mode.
bool asks_for(const PlayOptions& options, DeliveryMode mode);

/// Whether this machine may have to make views from the scene.
bool needs_scene(const PlayOptions& options);

} // namespace fieldcast::client::play
