// SPDX-License-Identifier: Apache-2.0
#include "tests/server/synthetic.h"

#include "core/wire/convert.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <mutex>

namespace fieldcast::test {

namespace {

constexpr std::size_t kBundleBytes = 5U << 19;

Plane synthetic_plane(PlaneSemantic semantic, std::uint32_t width_px, std::uint32_t height_px, std::uint64_t seed) {
    const PlaneFormat format = usual_format(semantic);
    Plane plane{.semantic = semantic, .format = format, .width_px = width_px, .height_px = height_px, .bytes = {}};
    plane.bytes.resize(plane_bytes(format, width_px, height_px));
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        plane.bytes[i] = static_cast<std::byte>((i * 7 + seed * 13) & 0x7FU);
    }
    return plane;
}

FrameHeader synthetic_header(const feed::ChannelInfo& info, std::uint64_t frame_id) {
    FrameHeader header;
    header.frame_id = frame_id;
    header.scene_time_ns = static_cast<std::int64_t>(frame_id) * 10'000'000;
    header.seed = static_cast<std::uint32_t>(frame_id);
    header.source = make_camera(glm::mat4(1.0F), info.fovy_rad, info.source_width_px, info.source_height_px);
    header.guard_band = info.guard_band;
    header.inverse_depth_unit = 0.01F; // frames for clients without the scene have planes of inverse depth
    return header;
}

SourceFrame synthetic_source(const feed::ChannelInfo& info, const feed::Demand& demand, std::uint64_t frame_id) {
    SourceFrame source;
    source.header = synthetic_header(info, frame_id);
    for (const wire::PlaneChoice& choice : demand.planes) {
        if (source.find(choice.semantic) == nullptr) {
            source.planes.push_back(synthetic_plane(choice.semantic, plane_width(source.header, choice.semantic),
                                                    plane_height(source.header, choice.semantic), frame_id));
        }
    }
    return source;
}

Views synthetic_views(const feed::ChannelInfo& info, const feed::ViewDemand& demand, std::uint64_t frame_id) {
    Views views{.header = synthetic_header(info, frame_id), .views = {}};
    for (const LatticePosition position : demand.positions) {
        const wire::ViewFormat& format = demand.format;
        views.views.push_back(
            {.position = position,
             .image = synthetic_plane(PlaneSemantic::kColour, format.width_px, format.height_px, frame_id),
             .discards = {.out_of_frustum = 1}});
    }
    return views;
}

void publish_until(const std::stop_token& stop, feed::Feed& feed) {
    WorkerPool pool(1);
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    for (std::uint64_t frame_id = 1; feed.wait_for_demand(stop); ++frame_id) {
        feed.publish(synthetic_frame(feed.info(), feed.demand(), frame_id, pool));
        never.wait_for(lock, stop, std::chrono::milliseconds(10), [] { return false; });
    }
}

} // namespace

feed::ChannelInfo synthetic_info(const std::string& name) {
    feed::ChannelInfo info;
    info.name = name;
    info.scene_hash.fill(0xAB);
    info.source_width_px = 64;
    info.source_height_px = 36;
    info.largest_grid.geometry.spacing_m = glm::vec2(0.02F);
    info.frames_per_second = 100.0F;
    info.guard_band = {.left_px = 2, .right_px = 3, .top_px = 1, .bottom_px = 1};
    info.camera = "LightField";
    info.max_view_pixels = 72ULL * 64 * 36;
    std::vector<std::byte> bundle(kBundleBytes);
    for (std::size_t i = 0; i < bundle.size(); ++i) {
        bundle[i] = static_cast<std::byte>(i % 251);
    }
    info.bundle = std::make_shared<const std::vector<std::byte>>(std::move(bundle));
    return info;
}

feed::FramePtr synthetic_frame(const feed::ChannelInfo& info, const feed::Demand& demand, std::uint64_t frame_id,
                               WorkerPool& pool, std::uint64_t key_frame_id) {
    auto frame = std::make_shared<feed::EncodedFrame>();
    frame->header = synthetic_header(info, frame_id);
    frame->key_frame_id = key_frame_id;
    frame->begun = demand.begun;
    wire::KeyFrame key{.frame_id = key_frame_id, .is_optional = demand.needs_alone};
    const bool refers = key_frame_id != 0 && key_frame_id != frame_id;
    if (!demand.planes.empty()) {
        const SourceFrame source = synthetic_source(info, demand, frame_id);
        const SourceFrame key_source = synthetic_source(info, demand, frame_id); // everything is repeated
        key.source = refers ? &key_source : nullptr;
        frame->source = wire::encode_source(source, demand.planes, key, pool);
    }
    for (const feed::ViewDemand& views : demand.views) {
        const Views key_views = synthetic_views(info, views, frame_id);
        key.views = refers ? &key_views : nullptr;
        frame->views.push_back(wire::encode_views(synthetic_views(info, views, frame_id), views.format, key, pool));
    }
    return frame;
}

SyntheticChannel::SyntheticChannel(feed::ChannelInfo info)
    : SyntheticChannel(std::make_shared<feed::Feed>(std::move(info))) {}

SyntheticChannel::SyntheticChannel(std::shared_ptr<feed::Feed> feed)
    : feed_(std::move(feed)),
      thread_([this](const std::stop_token& stop) { publish_until(stop, *feed_); }) {}

} // namespace fieldcast::test
