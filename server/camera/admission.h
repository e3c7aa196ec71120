// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/feed_opener.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

// Decides which clients may have a camera of their own, so that every camera keeps its promised device time.
namespace fieldcast::camera {

/// Limits on all own cameras of a server together.
struct Limits {
    std::uint32_t max_cameras = 4;
    double max_ms_per_second = 1000.0; ///< device time per second, ms
};

/// Estimated device time of a frame.
struct FrameCost {
    double source_ms = 0.0;             ///< of a frame without views
    double ms_per_view_megapixel = 0.0; ///< per million pixels of all its views together

    /// Device time of a frame with that many pixels in all views, ms.
    double of(std::uint64_t view_pixels) const {
        return source_ms + ms_per_view_megapixel * static_cast<double>(view_pixels) * 1e-6;
    }
};

/// The resource that was exhausted.
enum class Shortage : std::uint8_t { kCameras, kTime };

/// Why a camera, or a change of one, was refused.
struct Rejection {
    Shortage shortage = Shortage::kCameras;
    std::string message; ///< amount that was asked for, and amount that is left
};

/// Keeps the promised device time within the limits. The promise to a camera is frame rate × time of a frame; that time
/// begins as an estimate and follows the measured times. A camera alone on the device is never refused for time, so
/// that slow devices serve one client. A camera that has stopped rendering, because its client takes no frames, is
/// charged nothing until it renders again. Not thread-safe.
class Admission {
public:
    using Id = std::uint64_t;
    using Seconds = std::chrono::duration<double>;
    using TimePoint = std::chrono::steady_clock::time_point;

    /// A camera without a frame for longer is idle.
    static constexpr std::chrono::seconds kIdleAfter{5};

    explicit Admission(const Limits& limits) : limits_(limits) {}

    /// Sets the time; it must not go backwards.
    void look_at_clock(TimePoint now) { now_ = now; }

    /// Sets the estimated cost of a frame of `channel`'s cameras.
    void estimate(const std::string& channel, const FrameCost& cost);

    /// Admits the new camera `id` of `channel`, which must have an estimate. `replaced`, if any, is about to leave and
    /// does not count.
    std::optional<Rejection> admit(Id id, const std::string& channel, const feed::CameraLoad& load,
                                   std::optional<Id> replaced = std::nullopt);

    /// Changes the load of `id`. On rejection its old load stays.
    std::optional<Rejection> change(Id id, const feed::CameraLoad& load);
    void stop(Id id);  ///< it renders no more frames, but keeps its place until it leaves; `id` may be unknown
    void leave(Id id); ///< frees its place; `id` may be unknown

    /// A frame of `id` used that much device time. The first two after a change do not count: they allocate buffers.
    void observe(Id id, Seconds used);

    /// False until the camera that `id` replaces has left.
    bool has_place(Id id) const;

    std::uint32_t cameras_of(const std::string& channel) const;
    double promised_ms_per_second(const std::string& channel) const;

private:
    struct Channel {
        FrameCost cost;
        double correction = 1.0; ///< recent ratio of measured to estimated time, over its cameras
    };
    struct Camera {
        std::string channel;
        feed::CameraLoad load;
        std::optional<Id> replaced = std::nullopt; ///< takes its place once that has left
        double correction = 1.0;                   ///< the same ratio, of its own frames
        int uncounted = 0;                         ///< next frames whose time does not count
        std::optional<TimePoint> last_frame = std::nullopt; ///< unset: none yet, the camera is being made
    };

    std::size_t places() const;                 ///< number of taken places
    bool is_idle(const Camera& camera) const;
    double promise(const Camera& camera) const; ///< ms per second
    double charge(const Camera& camera) const;  ///< its promise, ms per second; 0 while it is idle
    std::optional<Rejection> time_problem(Id except, std::optional<Id> replaced, const Camera& wanted) const;

    const Limits limits_;
    std::map<std::string, Channel> channels_;
    std::map<Id, Camera> cameras_;
    TimePoint now_{};
};

} // namespace fieldcast::camera
