// SPDX-License-Identifier: Apache-2.0
#include "server/channel/channel_metrics.h"

namespace fieldcast::channel {

namespace {

const metrics::Description kStages{"fieldcast_stage_seconds", "Time on the device per frame, by stage of rendering."};
const metrics::Description kHoles{"fieldcast_hole_pixels_total",
                                  "Pixels of views that the source does not show, by reason. Divided by "
                                  "fieldcast_view_pixels_total: the share of discards."};

} // namespace

ChannelMetrics::ChannelMetrics(metrics::Registry& registry, const std::string& channel)
    : registry_(registry), channel_(channel),
      frames_(
          registry.counter({"fieldcast_frames_rendered_total", "Frames that were rendered."}, {{"channel", channel}})),
      invalid_samples_(registry.counter(
          {"fieldcast_invalid_samples_total", "Samples that were infinite or no number; should stay 0."},
          {{"channel", channel}})),
      view_pixels_(registry.counter({"fieldcast_view_pixels_total", "Pixels of all views that were made."},
                                    {{"channel", channel}})),
      asked_views_(view_counter("asked")), rendered_views_(view_counter("rendered")),
      encoded_views_(view_counter("encoded")),
      render_(registry.histogram({"fieldcast_render_seconds", "Wall time of rendering a frame with all its views."},
                                 {{"channel", channel}}, metrics::second_bounds())),
      encode_(registry.histogram({"fieldcast_encode_seconds", "Wall time of encoding a frame in all its forms."},
                                 {{"channel", channel}}, metrics::second_bounds())),
      turn_wait_(registry.histogram({"fieldcast_device_wait_seconds", "Wall time before a frame had the device."},
                                    {{"channel", channel}}, metrics::second_bounds())),
      turn_(registry.histogram({"fieldcast_device_seconds", "Wall time in which a frame had the device for itself."},
                               {{"channel", channel}}, metrics::second_bounds())) {
    for (const char* const reason : {"out_of_frustum", "id", "plane", "normal"}) {
        hole_pixels_[reason] = &registry.counter(kHoles, {{"channel", channel}, {"reason", reason}});
    }
}

metrics::Counter& ChannelMetrics::view_counter(const char* step) const {
    return registry_.counter({"fieldcast_views_total",
                              "Views of all frames, by step: asked for by clients, rendered, encoded. Asked for beyond "
                              "encoded: shared by clients."},
                             {{"channel", channel_}, {"step", step}});
}

metrics::Histogram& ChannelMetrics::stage(const std::string& name) {
    metrics::Histogram*& known = stages_[name];
    if (known == nullptr) {
        known = &registry_.histogram(kStages, {{"channel", channel_}, {"stage", name}}, metrics::second_bounds());
    }
    return *known;
}

void ChannelMetrics::observe_stage(const StageTime& time) {
    stage(time.stage).observe(time.ms * 1e-3);
}

void ChannelMetrics::count_rendered(const RenderedFrame& frame, std::uint64_t invalid_samples) {
    frames_.add();
    invalid_samples_.add(invalid_samples);
    render_.observe(static_cast<double>(frame.times.render_end_ns - frame.times.render_begin_ns) * 1e-9);
    for (const StageTime& time : frame.header.render_times) {
        observe_stage(time);
    }
    asked_views_.add(frame.asked_views);
    for (const RenderedViews& rendered : frame.views) {
        rendered_views_.add(rendered.views.views.size());
        const auto& times = rendered.views.header.render_times; // of the source first, then of the views
        for (std::size_t i = frame.header.render_times.size(); i < times.size(); ++i) {
            observe_stage(times[i]);
        }
        for (const View& view : rendered.views.views) {
            view_pixels_.add(static_cast<std::uint64_t>(view.image.width_px) * view.image.height_px);
            hole_pixels_.at("out_of_frustum")->add(view.discards.out_of_frustum);
            hole_pixels_.at("id")->add(view.discards.id);
            hole_pixels_.at("plane")->add(view.discards.plane);
            hole_pixels_.at("normal")->add(view.discards.normal);
        }
    }
}

void ChannelMetrics::observe_turn(const Turn& turn) {
    turn_wait_.observe(turn.waited.count());
    turn_.observe(turn.used.count());
}

void ChannelMetrics::count_encoded(const feed::EncodedFrame& frame, std::chrono::duration<double> seconds) {
    encode_.observe(seconds.count());
    for (const wire::EncodedViews& views : frame.views) {
        encoded_views_.add(views.views.size());
    }
}

} // namespace fieldcast::channel
