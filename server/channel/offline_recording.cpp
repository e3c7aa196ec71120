// SPDX-License-Identifier: Apache-2.0
#include "server/channel/offline_recording.h"

#include "server/channel/frame_encoder.h"
#include "server/recording/recording_writer.h"

namespace fieldcast::channel {

bool record_offline(const gpu::Device& device, const Settings& settings, const RecordJob& job,
                    const OfflineProgress& progress) {
    FrameRenderer renderer(device, settings, settings.channels.front());
    feed::ChannelInfo info = renderer.info();
    feed::Demand demand;
    demand.needs_alone = true; // so that clients may join at any frame
    for (const recording::RecordedForm& form : settings.record_forms) {
        info.recorded.push_back(recording::selection_of(form, info));
        feed::add(demand, info.recorded.back());
    }
    recording::RecordingWriter writer(job.out, info);
    FrameEncoder encoder;
    for (std::uint32_t frame = 0; frame < job.frame_count; ++frame) {
        if (progress("frame " + std::to_string(frame + 1) + " of " + std::to_string(job.frame_count))) {
            return false;
        }
        const double time_s = frame / static_cast<double>(settings.frames_per_second);
        const auto at = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(time_s));
        const auto shown_at =
            FrameEncoder::TimePoint(std::chrono::duration_cast<FrameEncoder::TimePoint::duration>(at));
        RenderedFrame rendered = renderer.render(frame + 1, offline_moment(settings, frame), demand);
        const feed::FramePtr encoded = encoder.encode(std::move(rendered), shown_at);
        FC_ASSERT(writer.add(*encoded, at), "a frame was rendered that cannot be recorded");
    }
    writer.finish();
    return true;
}

} // namespace fieldcast::channel
