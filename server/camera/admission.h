// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/feed_opener.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

// Who may have a camera of its own, so that those that are there keep what they were promised.
namespace fieldcast::camera {

/// Of all own cameras of a server together.
struct Limits {
    std::uint32_t max_cameras = 4;
    double max_ms_per_second = 1000.0; ///< of the device
};

/// What a frame takes of the device, as far as it can be known beforehand.
struct FrameCost {
    double source_ms = 0.0;             ///< without views
    double ms_per_view_megapixel = 0.0; ///< of all its views

    double of(std::uint64_t view_pixels) const {
        return source_ms + ms_per_view_megapixel * static_cast<double>(view_pixels) * 1e-6;
    }
};

enum class Shortage : std::uint8_t { kCameras, kTime };

/// Why somebody does not get what it wants.
struct Rejection {
    Shortage shortage = Shortage::kCameras;
    std::string message; ///< what was asked, and what is left
};

/// Keeps the promised device time within the limits. A promise is frame rate × time of a frame; that time begins as an
/// estimate and follows what the frames really take. Whoever is alone always gets what it wants, so that slow devices
/// serve somebody. A camera that has stopped rendering, because its client takes no frames, is charged nothing until it
/// renders again. Not thread-safe.
class Admission {
public:
    using Id = std::uint64_t;
    using Seconds = std::chrono::duration<double>;
    using TimePoint = std::chrono::steady_clock::time_point;

    /// Without a frame for longer, a camera is idle.
    static constexpr std::chrono::seconds kIdleAfter{5};

    explicit Admission(const Limits& limits) : limits_(limits) {}

    /// It is `now`; must not go backwards.
    void look_at_clock(TimePoint now) { now_ = now; }

    /// Of frames of the cameras of `channel`.
    void estimate(const std::string& channel, const FrameCost& cost);

    /// `id` is new and belongs to `channel`, of which there is an estimate. `replaced`, if any, is about to
    /// leave and does not count.
    std::optional<Rejection> admit(Id id, const std::string& channel, const feed::CameraLoad& load,
                                   std::optional<Id> replaced = std::nullopt);

    /// On rejection, what `id` had before stays.
    std::optional<Rejection> change(Id id, const feed::CameraLoad& load);
    void stop(Id id);  ///< it makes no more frames, and keeps its place until it leaves; it may be unknown
    void leave(Id id); ///< it may be unknown

    /// A frame of `id` has taken so long. The first ones after a change do not count: they make room for new views.
    void observe(Id id, Seconds used);

    /// False while the one is there that it replaces.
    bool has_place(Id id) const;

    std::uint32_t cameras_of(const std::string& channel) const;
    double promised_ms_per_second(const std::string& channel) const;

private:
    struct Channel {
        FrameCost cost;
        double correction = 1.0; ///< real over estimated, of its cameras lately
    };
    struct Camera {
        std::string channel;
        feed::CameraLoad load;
        std::optional<Id> replaced = std::nullopt; ///< whose place it takes when that has left
        double correction = 1.0;                   ///< of its own frames
        int uncounted = 0;                         ///< frames still to come that do not count
        std::optional<TimePoint> last_frame = std::nullopt; ///< unset: it is still being made
    };

    std::size_t places() const;                 ///< that are taken
    bool is_idle(const Camera& camera) const;
    double promise(const Camera& camera) const; ///< ms per second
    double charge(const Camera& camera) const;  ///< its promise, while it is not idle
    std::optional<Rejection> time_problem(Id except, std::optional<Id> replaced, const Camera& wanted) const;

    const Limits limits_;
    std::map<std::string, Channel> channels_;
    std::map<Id, Camera> cameras_;
    TimePoint now_{};
};

} // namespace fieldcast::camera
