// SPDX-License-Identifier: Apache-2.0
#include "client/play/pilot.h"

#include "client/net/clock_sync.h"
#include "core/base/log.h"

namespace fieldcast::client::play {
namespace {

constexpr std::chrono::milliseconds kPosePeriod{16}; // about the frame time of a 60 Hz display
constexpr int kKeepAlivesPerLease = 3;               // two may be late

} // namespace

void Pilot::begin(net::ClientSession& session) {
    lease_ = 0;
    start_.reset();
    session.send(net::to_request(options_.waits));
}

void Pilot::steer(net::ClientSession& session, Clock::time_point now) {
    if (!is_steering() || now < next_pose_) {
        return;
    }
    next_pose_ = now + kPosePeriod;
    const double seconds = std::chrono::duration<double>(now - begun_).count();
    const auto pose = start_ ? options_.poses(seconds, *start_) : std::nullopt; // no `start_` before the first frame
    if (pose) {
        session.send(net::to_pose(*pose, ++sequence_, net::steady_now_ns()));
    } else if (now - last_sent_ >= keep_alive_period_) {
        session.send(net::keep_alive());
    } else {
        return;
    }
    last_sent_ = now;
}

std::optional<std::string> Pilot::handle(net::ClientSession& session, const net::SteeringNews& news,
                                         Clock::time_point now) {
    using Kind = net::SteeringNews::Kind;
    switch (news.kind) {
    case Kind::kGranted:
        log::info("we steer", {{"lease", news.lease}});
        lease_ = news.lease;
        sequence_ = shown_sequence_ = 0;
        keep_alive_period_ = news.expires_after / kKeepAlivesPerLease;
        begun_ = next_pose_ = last_sent_ = now;
        return std::nullopt;
    case Kind::kWaiting:
        log::warn("waiting for the camera", {{"reason", news.message}});
        return std::nullopt;
    case Kind::kPassedOver:
        log::warn("server ignored a pose", {{"reason", news.message}});
        return std::nullopt;
    case Kind::kRefused:
        return "not steering: " + news.message;
    case Kind::kExpired:
        session.send(net::to_request(true));
        [[fallthrough]];
    case Kind::kReleased:
        log::warn("we no longer steer", {{"reason", news.message}});
        lease_ = 0;
        return std::nullopt;
    }
    return std::nullopt;
}

std::optional<std::int64_t> Pilot::chosen_ns(const FrameHeader& header) {
    if (!start_) {
        start_ = header.source.world_from_camera;
    }
    const std::optional<AppliedPose>& applied = header.applied_pose;
    if (!is_steering() || !applied || applied->lease != lease_ || applied->sequence <= shown_sequence_) {
        return std::nullopt;
    }
    shown_sequence_ = applied->sequence;
    return applied->client_time_ns;
}

} // namespace fieldcast::client::play
