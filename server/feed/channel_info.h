// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"
#include "server/feed/selection.h"
#include "server/feed/view_memory.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fieldcast::feed {

inline constexpr std::size_t kMaxChannelNameBytes = 64;

/// How the camera of a channel moves.
enum class CameraControl : std::uint8_t {
    kFixed,
    kScripted, ///< the animation of a camera node of the scene
    kSteered,  ///< by one client at a time
    kOwn,      ///< every client has a camera of its own
};

/// Whether clients move the camera; its node in the scene then gives only the start pose.
inline bool is_moved_by_clients(CameraControl control) {
    return control == CameraControl::kSteered || control == CameraControl::kOwn;
}

/// Facts about a channel, fixed when it starts.
struct ChannelInfo {
    std::string name;
    std::array<std::uint8_t, 32> scene_hash{}; ///< SHA-256 of `bundle`
    std::uint32_t source_width_px = 0;         ///< without guard band
    std::uint32_t source_height_px = 0;        ///< without guard band
    std::uint32_t source_count = 1;            ///< source images, stacked in the planes
    float fovy_rad = 0.785398F;                ///< vertical, of the source without guard band
    ViewGrid largest_grid;                     ///< its geometry is the lattice of the channel
    float frames_per_second = 30.0F;           ///< highest rate
    GuardBand guard_band;
    std::string camera;                                   ///< name of the camera node
    CameraControl control = CameraControl::kFixed;
    std::chrono::milliseconds steering_lease{5'000};      ///< kSteered: longest time between renewals of a lease
    std::shared_ptr<const std::vector<std::byte>> bundle; ///< scene that FetchScene sends; null: none
    std::uint8_t lossy_quality = 75;                      ///< of planes in a lossy codec, if the client names none
    std::uint64_t max_view_pixels = 0;                    ///< most pixels encoded per frame, over all clients
    std::uint64_t bytes_per_view_pixel = 0;               ///< device memory per pixel of a view
    std::shared_ptr<ViewMemory> view_memory{};            ///< device memory for views of all channels; null: no limit
    std::vector<Selection> recorded{}; ///< not empty: the channel is a recording and offers only these
};

} // namespace fieldcast::feed
