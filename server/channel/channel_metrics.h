// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/frame_renderer.h"
#include "server/metrics/registry.h"

#include <chrono>
#include <map>
#include <string>

namespace fieldcast::channel {

/// Metrics of one channel. Each function may be called by one thread; `registry` must outlive it.
class ChannelMetrics {
public:
    ChannelMetrics(metrics::Registry& registry, const std::string& channel);

    void count_rendered(const RenderedFrame& frame, std::uint64_t invalid_samples); ///< samples: of this frame
    /// A turn at the device, which channels share.
    struct Turn {
        std::chrono::duration<double> waited; ///< from the request to its begin
        std::chrono::duration<double> used;
    };
    void observe_turn(const Turn& turn);
    void count_encoded(const feed::EncodedFrame& frame, std::chrono::duration<double> seconds);

private:
    void observe_stage(const StageTime& time);
    metrics::Histogram& stage(const std::string& name);
    metrics::Counter& view_counter(const char* step) const;

    metrics::Registry& registry_;
    const std::string channel_;
    metrics::Counter& frames_;
    metrics::Counter& invalid_samples_;
    metrics::Counter& view_pixels_;
    metrics::Counter& asked_views_;
    metrics::Counter& rendered_views_;
    metrics::Counter& encoded_views_;
    std::map<std::string, metrics::Counter*> hole_pixels_; ///< by reason
    metrics::Histogram& render_;
    metrics::Histogram& encode_;
    metrics::Histogram& turn_wait_;
    metrics::Histogram& turn_;
    std::map<std::string, metrics::Histogram*> stages_; ///< seen so far, by name
};

} // namespace fieldcast::channel
