// SPDX-License-Identifier: Apache-2.0
#include "client/load/load_client.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::client::load {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

constexpr auto kFinishGrace = 2s; // for the server to finish after our half-close
constexpr double kFallbackFps = 30.0; // of the due schedule if neither the group nor the server defines one

std::int64_t to_ns(LoadClient::TimePoint time) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

std::chrono::nanoseconds rounded(Seconds seconds) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(seconds);
}

/// Mixes the seed: generators with neighbouring seeds begin with similar numbers.
std::uint32_t scattered(std::uint32_t seed) {
    return (seed + 1) * 2654435761U;
}

/// Adds a duration if both of its ends are known.
void add_between(LatencyHistogram& histogram, std::int64_t begin_ns, std::int64_t end_ns) {
    if (begin_ns != 0 && end_ns != 0) {
        histogram.add((end_ns - begin_ns) / 1000);
    }
}

} // namespace

LoadClient::LoadClient(Surroundings surroundings, std::uint32_t seed, TimePoint starts_at)
    : all_(std::move(surroundings)), random_(scattered(seed)), backoff_(scattered(seed)), opens_at_(starts_at) {}

LoadClient::TimePoint LoadClient::run() {
    const TimePoint now = Clock::now();
    if (!is_gone_ && !session_ && now >= opens_at_) {
        open(now);
    }
    if (session_ && leaves_at_ && now >= *leaves_at_ && !cut_at_) {
        if (all_.group->leaves_abruptly) {
            close(now);
        } else {
            leave(now, kFinishGrace);
        }
    }
    if (session_ && now >= thinks_until_) {
        read();
    }
    if (session_ && cut_at_ && now >= *cut_at_) {
        close(now);
    }
    return next_run();
}

LoadClient::TimePoint LoadClient::next_run() const {
    if (is_gone_) {
        return TimePoint::max();
    }
    if (!session_) {
        return opens_at_;
    }
    TimePoint when = std::max(session_->next_call(), thinks_until_);
    when = cut_at_ ? std::min(when, *cut_at_) : when;
    return leaves_at_ && !cut_at_ ? std::min(when, *leaves_at_) : when;
}

void LoadClient::open(TimePoint now) {
    const Group& group = *all_.group;
    net::ClientSession::Options options;
    options.decoding = group.decoding;
    options.reading.on_change = all_.on_change;
    if (group.max_bytes_per_second > 0.0 || group.think > 0s) { // unread messages stay on the server
        options.reading.max_waiting_bytes = 1;
        options.reading.max_bytes_per_second = group.max_bytes_per_second;
    }
    opened_at_ = now;
    present_since_ = present_since_.value_or(now);
    leaves_at_ = group.stay > 0s ? std::optional(now + rounded(spread(group.stay))) : std::nullopt;
    try {
        connection_.emplace(all_.scenario->address, all_.scenario->access);
        session_.emplace(*connection_, group.request, *all_.pool, std::move(options));
    } catch (const UserError& error) { // files of certificates or tokens may disappear and return
        add_loss(error.what());
        close(now);
    }
}

void LoadClient::add_loss(const std::string& reason) {
    auto tally = all_.tally->lock();
    ++tally->lost;
    tally->add_reason(reason);
}

/// Ends the session at once. The client reconnects later, unless it leaves for good.
void LoadClient::close(TimePoint now) {
    if (agreement_) {
        --all_.tally->lock()->connected;
    }
    const bool has_churned = leaves_at_ && now >= *leaves_at_;
    session_.reset();
    connection_.reset();
    agreement_.reset();
    last_frame_id_.reset();
    last_frame_ns_.reset();
    cut_at_.reset();
    if (is_leaving_for_good_) {
        is_gone_ = true;
    } else if (has_churned) {
        count_presence(now);
        end_due(now); // no due moment waits while the client is away
        opens_at_ = now + rounded(spread(all_.group->away));
    } else {
        opens_at_ = now + backoff_.next();
    }
}

void LoadClient::leave(TimePoint now, std::chrono::milliseconds grace) {
    session_->half_close();
    cut_at_ = now + grace;
    thinks_until_ = now;
}

void LoadClient::leave_for_good() {
    const TimePoint now = Clock::now();
    is_leaving_for_good_ = true;
    all_.window.end_ns = std::min(all_.window.end_ns, to_ns(now));
    count_presence(now);
    end_due(now);
    if (!session_) {
        is_gone_ = true;
    } else if (!cut_at_) {
        leave(now, kFinishGrace);
    }
}

void LoadClient::read() {
    while (session_) {
        const auto event = session_->next(Clock::now());
        if (!event) {
            return;
        }
        std::visit([this](const auto& each) { handle(each); }, *event);
        if (Clock::now() < thinks_until_) {
            return;
        }
    }
}

void LoadClient::handle(const net::Agreement& agreement) {
    agreement_ = agreement;
    begin_due();
    auto tally = all_.tally->lock();
    ++tally->connected;
    tally->of(Stage::kConnect).add((net::steady_now_ns() - to_ns(opened_at_)) / 1000);
}

void LoadClient::handle(const net::FrameArrived& frame) {
    backoff_.reset();
    thinks_until_ = Clock::now() + rounded(all_.group->think);
    auto tally = all_.tally->lock();
    if (!last_frame_id_) {
        tally->of(Stage::kFirstFrame).add((frame.decoded_ns - to_ns(opened_at_)) / 1000);
    }
    answer_due(frame, *tally);
    if (all_.window.contains(frame.decoded_ns)) {
        ++share_.frames;
        ++tally->frames;
        tally->bytes += frame.frame.payload_bytes;
        tally->not_sent += last_frame_id_ ? frame.frame_id - *last_frame_id_ - 1 : 0;
        Second& second = tally->second_of(all_.window, frame.decoded_ns);
        ++second.frames;
        second.bytes += frame.frame.payload_bytes;
        add_stages(frame, *tally);
    }
    last_frame_id_ = frame.frame_id;
    last_frame_ns_ = frame.decoded_ns;
}

void LoadClient::add_stages(const net::FrameArrived& frame, Tally& tally) {
    const wire::ServerTimes& server = frame.frame.server_times;
    add_between(tally.of(Stage::kPose), frame.pose_sampled_ns.value_or(0), frame.decoded_ns);
    add_between(tally.of(Stage::kRender), server.render_begin_ns, server.render_end_ns);
    add_between(tally.of(Stage::kEncode), server.render_end_ns, server.encode_end_ns);
    add_between(tally.of(Stage::kQueue), server.encode_end_ns, server.send_begin_ns);
    add_between(tally.of(Stage::kSend), frame.send_begin_ns.value_or(0), frame.last_byte_ns);
    add_between(tally.of(Stage::kTransfer), frame.first_byte_ns, frame.last_byte_ns);
    add_between(tally.of(Stage::kDecode), frame.last_byte_ns, frame.decoded_ns);
    add_between(tally.of(Stage::kInterval), last_frame_ns_.value_or(0), frame.decoded_ns);
}

Seconds LoadClient::due_period() const {
    if (all_.group->due_fps > 0.0) {
        return Seconds(1.0 / all_.group->due_fps);
    }
    const double agreed = agreement_ ? agreement_->frames_per_second : 0.0;
    return Seconds(1.0 / (agreed > 0.0 ? agreed : kFallbackFps));
}

/// The schedule begins at a random phase when the client connects, so that clients are not synchronised with each other
/// or the server. A client that reconnects after a loss keeps its schedule.
void LoadClient::begin_due() {
    if (!due_) {
        const Seconds period = due_period();
        const Seconds phase = period * std::uniform_real_distribution<double>(0.0, 1.0)(random_);
        due_.emplace(to_ns(opened_at_) + rounded(phase).count(), rounded(period));
    }
}

/// Ends the schedule: the client leaves on purpose, or the window ends.
void LoadClient::end_due(TimePoint now) {
    if (due_) {
        auto tally = all_.tally->lock();
        tally->cut_off += due_->cut_off(std::min(to_ns(now), all_.window.end_ns), all_.window, tally->of(Stage::kDue));
        due_.reset();
    }
}

void LoadClient::answer_due(const net::FrameArrived& frame, Tally& tally) {
    if (!due_) {
        return; // it is leaving
    }
    const bool is_posed = frame.pose_sampled_ns.has_value();
    const bool counts = all_.window.contains(frame.decoded_ns);
    tally.without_pose_time += counts && !is_posed ? 1 : 0;
    const std::int64_t pose_ns = frame.pose_sampled_ns.value_or(frame.first_byte_ns);
    const std::int64_t longest_us = due_->answer(pose_ns, frame.decoded_ns, all_.window, tally.of(Stage::kDue));
    if (counts) {
        Second& second = tally.second_of(all_.window, frame.decoded_ns);
        second.longest_due_us = std::max(second.longest_due_us, longest_us);
    }
}

void LoadClient::handle(const net::FrameFailed& failed) {
    if (all_.window.contains(net::steady_now_ns())) {
        auto tally = all_.tally->lock();
        ++tally->failed;
        tally->add_reason("frame failed: " + failed.reason);
    }
}

void LoadClient::handle(const net::FrameAborted& /*aborted*/) {
    if (all_.window.contains(net::steady_now_ns())) {
        ++all_.tally->lock()->aborted;
    }
}

void LoadClient::handle(const net::Refused& refused) {
    {
        auto tally = all_.tally->lock();
        ++tally->refused;
        tally->add_reason("refused: " + refused.message);
    }
    is_leaving_for_good_ = is_leaving_for_good_ || !refused.is_transient;
    close(Clock::now());
}

void LoadClient::handle(const net::GoingAway& going) {
    {
        auto tally = all_.tally->lock();
        ++tally->sent_away;
        tally->add_reason("sent away: " + going.reason);
    }
    leave(Clock::now(), std::clamp<std::chrono::milliseconds>(going.deadline, 100ms, 10s));
}

void LoadClient::handle(const net::Ended& ended) {
    const std::string message = ended.error.what();
    const bool was_asked_for = cut_at_.has_value() && message.empty();
    if (!was_asked_for) {
        add_loss(message.empty() ? "the server finished first" : message);
    }
    is_leaving_for_good_ = is_leaving_for_good_ || !ended.error.is_transient();
    close(Clock::now());
}

/// Ends the current time of presence and adds it to the total.
void LoadClient::count_presence(TimePoint until) {
    if (present_since_) {
        const std::int64_t begin_ns = std::max(to_ns(*present_since_), all_.window.begin_ns);
        const std::int64_t end_ns = std::min(to_ns(until), all_.window.end_ns);
        share_.seconds += std::max(0.0, static_cast<double>(end_ns - begin_ns) * 1e-9);
        present_since_.reset();
    }
}

/// A random duration between 0.5 and 1.5 times `mean`.
Seconds LoadClient::spread(Seconds mean) {
    return mean * std::uniform_real_distribution<double>(0.5, 1.5)(random_);
}

} // namespace fieldcast::client::load
