// SPDX-License-Identifier: Apache-2.0
#include "server/camera/admission.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::camera {

namespace {

constexpr int kUncountedFrames = 2; // these allocate buffers for views and run kernels for the first time
constexpr double kNewest = 0.2;     // weight of a new frame: averages over about a second at usual rates
constexpr double kLeastCorrection = 0.001;
constexpr double kMostCorrection = 1000.0; // one frame that others delayed must not block admission for long

void follow(double& average, double value) {
    average = std::clamp(average + kNewest * (value - average), kLeastCorrection, kMostCorrection);
}

std::string rounded(double number) {
    return std::to_string(std::llround(number));
}

} // namespace

void Admission::estimate(const std::string& channel, const FrameCost& cost) {
    channels_[channel] = {.cost = cost};
}

std::optional<Rejection> Admission::admit(Id id, const std::string& channel, const feed::CameraLoad& load,
                                          std::optional<Id> replaced) {
    const std::size_t leaving = replaced && cameras_.contains(*replaced) ? 1 : 0;
    if (places() - leaving >= limits_.max_cameras) {
        return Rejection{.shortage = Shortage::kCameras,
                         .message = "all " + std::to_string(limits_.max_cameras) +
                                    " cameras that this server gives to single clients are in use"};
    }
    const Camera camera{.channel = channel,
                        .load = load,
                        .replaced = replaced,
                        .correction = channels_.at(channel).correction,
                        .uncounted = kUncountedFrames};
    auto problem = time_problem(id, replaced, camera);
    if (!problem) {
        cameras_.emplace(id, camera);
    }
    return problem;
}

std::optional<Rejection> Admission::change(Id id, const feed::CameraLoad& load) {
    Camera changed = cameras_.at(id);
    if (changed.load == load) {
        return std::nullopt;
    }
    const double before = promise(changed);
    changed.load = load;
    changed.uncounted = kUncountedFrames;
    if (promise(changed) > before) { // a smaller load is always allowed
        if (auto problem = time_problem(id, std::nullopt, changed)) {
            return problem;
        }
    }
    cameras_.at(id) = changed;
    return std::nullopt;
}

void Admission::stop(Id id) {
    const auto found = cameras_.find(id);
    if (found != cameras_.end()) {
        found->second.load.frames_per_second = 0.0F;
    }
}

void Admission::leave(Id id) {
    cameras_.erase(id);
}

void Admission::observe(Id id, Seconds used) {
    const auto found = cameras_.find(id);
    if (found == cameras_.end()) {
        return; // its last frame: it has left
    }
    Camera& camera = found->second;
    camera.last_frame = now_;
    if (camera.uncounted > 0) {
        --camera.uncounted;
        return;
    }
    Channel& channel = channels_.at(camera.channel);
    const double estimated_ms = channel.cost.of(camera.load.view_pixels);
    if (estimated_ms > 0.0) {
        const double correction = used.count() * 1e3 / estimated_ms;
        follow(camera.correction, correction);
        follow(channel.correction, correction);
    }
}

bool Admission::has_place(Id id) const {
    const std::optional<Id> replaced = cameras_.at(id).replaced;
    return !(replaced && cameras_.contains(*replaced));
}

std::uint32_t Admission::cameras_of(const std::string& channel) const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(cameras_, [&](const auto& entry) { return entry.second.channel == channel; }));
}

double Admission::promised_ms_per_second(const std::string& channel) const {
    double sum = 0.0;
    for (const auto& [id, camera] : cameras_) {
        sum += camera.channel == channel ? charge(camera) : 0.0;
    }
    return sum;
}

std::size_t Admission::places() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(cameras_, [&](const auto& entry) { return has_place(entry.first); }));
}

bool Admission::is_idle(const Camera& camera) const {
    const bool has_stopped = camera.load.frames_per_second == 0.0F;
    return has_stopped || (camera.last_frame && now_ - *camera.last_frame > kIdleAfter);
}

double Admission::charge(const Camera& camera) const {
    return is_idle(camera) ? 0.0 : promise(camera);
}

double Admission::promise(const Camera& camera) const {
    const double frame_ms = channels_.at(camera.channel).cost.of(camera.load.view_pixels) * camera.correction;
    return frame_ms * static_cast<double>(camera.load.frames_per_second);
}

std::optional<Rejection> Admission::time_problem(Id except, std::optional<Id> replaced, const Camera& wanted) const {
    double others = 0.0;
    bool is_alone = true;
    for (const auto& [id, camera] : cameras_) {
        if (id != except && id != replaced) {
            others += charge(camera);
            is_alone = is_alone && is_idle(camera);
        }
    }
    const double asked = promise(wanted);
    if (is_alone || others + asked <= limits_.max_ms_per_second) {
        return std::nullopt;
    }
    return Rejection{.shortage = Shortage::kTime,
                     .message = rounded(asked) + " ms of the device per second asked (" +
                                rounded(static_cast<double>(wanted.load.frames_per_second)) +
                                " frames per second with " + std::to_string(wanted.load.view_pixels) +
                                " pixels of views); " + rounded(std::max(limits_.max_ms_per_second - others, 0.0)) +
                                " of " + rounded(limits_.max_ms_per_second) +
                                " are left; ask for fewer frames, or fewer or smaller views"};
}

} // namespace fieldcast::camera
