// SPDX-License-Identifier: Apache-2.0
#include "client/play/playback.h"

#include "client/play/frame_record.h"
#include "client/play/local_renderers.h"
#include "core/base/error.h"
#include "core/base/log.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <deque>
#include <memory>

namespace fieldcast::client::play {
namespace {

/// A shown frame, kept while it may have to be written.
struct Shown {
    std::uint64_t frame_id = 0;
    ViewGrid grid;
    Views views;
    DeliveryMode mode = DeliveryMode::kViews;
};

constexpr std::size_t kRememberedEpochs = 256;
constexpr std::size_t kRememberedFrames = 1U << 16; // endless runs have statistics of the last ones

std::optional<double> ms_between(const std::optional<std::int64_t>& begin_ns, std::int64_t end_ns) {
    return begin_ns ? std::optional(static_cast<double>(end_ns - *begin_ns) * 1e-6) : std::nullopt;
}

std::string mode_text(const net::Agreement& agreement) {
    const std::string word(word_of(agreement.mode));
    if (row_of(agreement.mode).needs_scene) {
        return word + ", " + std::string(word_of(agreement.request.planes));
    }
    return is_made_by_client(agreement.mode) && !agreement.request.has_residual ? word + ", without residual layer"
                                                                                : word;
}

std::string grid_text(const ViewGrid& grid) {
    return std::to_string(grid.rows) + "x" + std::to_string(grid.cols);
}

/// Why the server changed the configuration; empty: we requested it.
std::string reason_text(const net::Agreement& agreement) {
    if (!agreement.adapted) {
        return "";
    }
    const net::Adapted& adapted = *agreement.adapted;
    return adapted.change + ", " +
           (adapted.is_recovery ? "recovered" : "queue of " + std::to_string(adapted.queue_delay_ms) + " ms");
}

std::string size_text(const wire::ViewSet& set) {
    return std::to_string(set.width_px) + "x" + std::to_string(set.height_px);
}

/// Shows frames: makes their views, writes their files, and keeps statistics.
class Player {
public:
    Player(const PlayOptions& options, LocalRenderers* renderers, timing::TimingRecorder* recorder)
        : options_(options), renderers_(renderers), recorder_(recorder) {}

    /// False if the frame could not be shown.
    bool show(Arrival arrival);
    /// Writes the last frame with Save::kLast.
    void finish();
    std::uint64_t shown_count() const { return shown_count_; }
    Summary summary(const StreamCounts& counts) const;
    Progress progress() const;

private:
    Decoded<Shown> make(Arrival& arrival);
    void write(const std::filesystem::path& folder) const;
    void record(const Arrival& arrival, std::int64_t begin_ns, std::int64_t rendered_ns, std::int64_t shown_ns);
    void count_epoch(const Arrival& arrival);

    const PlayOptions& options_;
    LocalRenderers* renderers_;  ///< null: the server makes all views
    timing::TimingRecorder* recorder_; ///< null: none
    std::optional<Shown> last_;
    std::uint64_t shown_count_ = 0;
    std::deque<ShownFrame> frames_; ///< the last ones
    std::deque<EpochSummary> epochs_; ///< the last ones
};

Decoded<Shown> Player::make(Arrival& arrival) {
    const wire::ViewSet& set = arrival.agreement.view_set;
    Shown shown;
    shown.frame_id = arrival.arrived.frame_id;
    shown.grid = set.grid;
    shown.mode = arrival.agreement.mode;
    if (auto* received = std::get_if<wire::ReceivedViews>(&arrival.arrived.frame.content)) {
        shown.views = std::move(received->views);
        return shown;
    }
    FC_ASSERT(renderers_ != nullptr, "only clients with renderers request source frames");
    Decoded<Views> views = renderers_->play(shown.mode, std::get<SourceFrame>(arrival.arrived.frame.content), set);
    if (!views) {
        return tl::unexpected(views.error());
    }
    shown.views = std::move(*views);
    return shown;
}

bool Player::show(Arrival arrival) {
    const std::int64_t begin_ns = net::steady_now_ns();
    Decoded<Shown> shown = make(arrival);
    const std::int64_t rendered_ns = net::steady_now_ns();
    if (!shown) {
        log::warn("frame not shown", {{"frame", arrival.arrived.frame_id}, {"reason", shown.error().message}});
        return false;
    }
    last_ = std::move(*shown);
    if (options_.save == Save::kAll) {
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "frame_%08llu", static_cast<unsigned long long>(last_->frame_id));
        write(options_.out / name.data());
    }
    const std::int64_t shown_ns = net::steady_now_ns();
    report_times(arrival, false, is_made_by_client(last_->mode) ? rendered_ns : 0, shown_ns);
    record(arrival, begin_ns, rendered_ns, shown_ns);
    return true;
}

void Player::record(const Arrival& arrival, std::int64_t begin_ns, std::int64_t rendered_ns, std::int64_t shown_ns) {
    ShownFrame frame;
    frame.frame_id = last_->frame_id;
    frame.payload_bytes = arrival.arrived.frame.payload_bytes;
    frame.send_to_decoded_ms = ms_between(arrival.arrived.send_begin_ns, arrival.arrived.decoded_ns);
    frame.pose_to_decoded_ms = ms_between(arrival.arrived.pose_sampled_ns, arrival.arrived.decoded_ns);
    frame.pose_to_shown_ms = ms_between(arrival.arrived.pose_sampled_ns, shown_ns);
    frame.motion_to_photon_ms = ms_between(arrival.pose_chosen_ns, shown_ns);
    frame.decode_ms = std::chrono::duration<double, std::milli>(arrival.arrived.frame.decode_time).count();
    const bool made_views = is_made_by_client(last_->mode);
    frame.render_ms = made_views ? static_cast<double>(rendered_ns - begin_ns) * 1e-6 : 0.0;
    frame.shown_ns = shown_ns;
    add_discards(last_->views, frame);
    if (arrival.record) {
        timing::DeliveredFrame full = *arrival.record;
        full.outcome = timing::Outcome::kShown;
        full.rendered_ns = made_views ? rendered_ns : 0;
        full.shown_ns = shown_ns;
        add_record(*recorder_, std::move(full));
    }
    frames_.push_back(frame);
    count_epoch(arrival);
    ++shown_count_;
    if (frames_.size() > kRememberedFrames) {
        frames_.pop_front();
    }
}

void Player::count_epoch(const Arrival& arrival) {
    const net::Agreement& agreement = arrival.agreement;
    const bool is_new = epochs_.empty() || epochs_.back().epoch != agreement.epoch ||
                        epochs_.back().session != arrival.session_number;
    if (is_new) {
        epochs_.push_back({.session = arrival.session_number,
                           .epoch = agreement.epoch,
                           .mode = mode_text(agreement),
                           .grid = grid_text(agreement.view_set.grid),
                           .view_size = size_text(agreement.view_set),
                           .first_frame = last_->frame_id,
                           .reason = reason_text(agreement)});
    }
    EpochSummary& epoch = epochs_.back();
    ++epoch.shown;
    epoch.last_frame = last_->frame_id;
    const auto bytes = static_cast<double>(arrival.arrived.frame.payload_bytes);
    epoch.bytes_per_frame += (bytes - epoch.bytes_per_frame) / static_cast<double>(epoch.shown);
    if (epochs_.size() > kRememberedEpochs) {
        epochs_.pop_front();
    }
}

void Player::write(const std::filesystem::path& folder) const {
    std::optional<SourceFrame> source;
    if (options_.products.source_exr && row_of(last_->mode).needs_scene) {
        source = renderers_->source(); // of the last frame played, which is the last one shown
    }
    const image::LightFieldPicture picture{last_->grid, last_->views, source ? &*source : nullptr};
    image::write_light_field(folder, picture, options_.products);
}

void Player::finish() {
    if (last_ && options_.save == Save::kLast) {
        write(options_.out);
    }
}

Summary Player::summary(const StreamCounts& counts) const {
    Summary summary = summarise({frames_.begin(), frames_.end()}, counts);
    summary.shown = shown_count_;
    summary.epochs.assign(epochs_.begin(), epochs_.end());
    return summary;
}

Progress Player::progress() const {
    Progress progress;
    progress.shown = shown_count_;
    progress.wanted = options_.frames;
    progress.latest = frames_.back();
    const double seconds = static_cast<double>(frames_.back().shown_ns - frames_.front().shown_ns) * 1e-9;
    progress.frames_per_second = seconds > 0.0 ? static_cast<double>(frames_.size() - 1) / seconds : 0.0;
    return progress;
}

void describe(const PlayOptions& options, const std::optional<net::Agreement>& agreement, Summary& summary) {
    net::Agreement asked;
    asked.mode = options.request.mode;
    asked.request = options.request;
    summary.mode = mode_text(agreement.value_or(asked));
    summary.grid = std::to_string(options.request.rows) + "x" + std::to_string(options.request.cols);
    if (agreement) {
        summary.grid = grid_text(agreement->view_set.grid);
        summary.view_size = size_text(agreement->view_set);
    }
}

} // namespace

PlayResult play(const PlayOptions& options, const OnProgress& on_progress, const std::stop_token& stop) {
    const std::unique_ptr<LocalRenderers> renderers = LocalRenderers::make(options, stop);
    std::optional<timing::TimingRecorder> recorder;
    if (options.timing_files.any()) {
        recorder.emplace(options.timing_files);
    }
    timing::TimingRecorder* const records = recorder ? &*recorder : nullptr;
    Receiver receiver(options.server, options.request, renderers ? renderers->scene_hash() : std::nullopt,
                      {.steering = options.steering, .changes = options.changes, .recorder = records});
    Player player(options, renderers.get(), records);
    std::optional<net::Agreement> agreement;
    const auto is_complete = [&] { return options.frames != 0 && player.shown_count() >= options.frames; };
    while (!is_complete()) {
        std::optional<Arrival> arrival = receiver.take(stop);
        if (!arrival) {
            break;
        }
        agreement = arrival->agreement;
        if (player.show(std::move(*arrival))) {
            on_progress(player.progress());
        }
    }
    receiver.finish();
    player.finish();
    PlayResult result;
    result.summary = player.summary(receiver.counts());
    describe(options, agreement, result.summary);
    if (!is_complete() && !stop.stop_requested()) {
        result.failure = receiver.failure();
    }
    return result;
}

} // namespace fieldcast::client::play
