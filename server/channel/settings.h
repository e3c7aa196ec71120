// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/lightfield/render_settings.h"
#include "core/lightfield/view_grid.h"
#include "core/scene/framing.h"
#include "core/scene/load_options.h"
#include "server/camera/own_cameras.h"
#include "server/feed/channel_info.h"
#include "server/recording/recorded_form.h"
#include "server/recording/replay.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::channel {

/// One channel: a scene under a name.
struct ChannelChoice {
    std::string name;
    std::filesystem::path scene;
    std::optional<feed::CameraControl> control{}; ///< unset: kScripted if the camera node moves, else kFixed
};

/// A channel to record while it is served.
struct RecordChoice {
    std::string channel; ///< empty: the only one
    std::filesystem::path file;
};

enum class GuardBandMode : std::uint8_t { kAuto, kFixed };

/// How a channel's scene time advances.
enum class ClockMode : std::uint8_t {
    kReal,   ///< wall clock
    kFrames, ///< 1/fps per rendered frame, however long it took
};

/// The scenes that a server shows and how it renders, records and replays them. Channels never change it.
struct Settings {
    std::vector<ChannelChoice> channels;
    std::vector<recording::ReplaySetup> replays; ///< channels that show a recording

    // Scenes, the same for all channels.
    std::optional<std::filesystem::path> environment; ///< an image; unset: `surroundings`
    scene::Surroundings surroundings = scene::Surroundings::kStudioIfUnlit;
    std::optional<glm::vec3> sky; ///< linear radiance; unset: the loader's default
    std::string camera;           ///< name or number of a camera node; empty: "LightField", else the first, else "auto"
    scene::FramingOptions framing; ///< of the camera "auto"
    bool has_fixed_camera = false;
    std::chrono::milliseconds steering_lease{5'000}; ///< inactivity after which the steering client loses the camera
    camera::Limits own_cameras{.max_cameras = 4, .max_ms_per_second = 1'000.0}; ///< over all channels
    std::optional<double> fixed_time_s;                                         ///< freezes the scene at that moment
    ClockMode clock = ClockMode::kReal;
    std::uint32_t loop_frames = 0; ///< ClockMode::kFrames: frames until the scene starts again; 0: never

    // Source image and lattice.
    std::uint32_t width_px = 1280;
    std::uint32_t height_px = 720;
    float frames_per_second = 30.0F; ///< at most
    std::optional<float> spacing_m;  ///< unset: the camera's, else it follows from the scene's depths
    bool has_convergence = false;    ///< false: follows from the scene's depths where the spacing does
    LatticeGeometry lattice;         ///< convergence; spacing is settled when the camera is known
    ViewGrid largest_grid;           ///< rows and columns
    GuardBandMode guard_band_mode = GuardBandMode::kAuto;
    GuardBand guard_band;                                            ///< kFixed
    std::vector<LatticePosition> source_positions = middle_source(); ///< views of the largest grid
    RenderSettings render;                                           ///< exposure: see `has_auto_exposure`
    bool has_auto_exposure = true;
    std::uint32_t seed = 1;
    std::uint32_t lossy_quality = 75; ///< of planes in a lossy codec, 1 to 100, if the client does not choose one

    // Recordings.
    std::vector<RecordChoice> records;
    std::vector<recording::RecordedForm> record_forms;
    std::uint64_t record_frames = 0; ///< of each recording; 0: until the server stops

    // Device.
    std::string traversal = "auto";
    std::string visibility = "auto";
    std::string device; ///< part of its name; empty: best
    bool has_validation = false;
    std::uint64_t max_channel_pixels = 2 * 72ULL * 1280 * 720; ///< views of one frame, over all clients
    std::optional<std::uint64_t> max_view_memory;              ///< bytes of the device; unset: half of what is free
};

} // namespace fieldcast::channel
