// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/parallel.h"
#include "server/feed/feed.h"

#include <memory>
#include <thread>

namespace fieldcast::test {

/// A channel of 64×36 pixels named `name`, with a bundle of 2.5 MiB.
feed::ChannelInfo synthetic_info(const std::string& name = "synthetic");

/// A frame that covers `demand`; pixels depend on `frame_id` only. With another frame as key frame, all strips repeat.
feed::FramePtr synthetic_frame(const feed::ChannelInfo& info, const feed::Demand& demand, std::uint64_t frame_id,
                               WorkerPool& pool, std::uint64_t key_frame_id = 0);

/// Publishes synthetic frames to a feed while somebody wants them: a channel without a renderer.
class SyntheticChannel {
public:
    explicit SyntheticChannel(feed::ChannelInfo info = synthetic_info());
    explicit SyntheticChannel(std::shared_ptr<feed::Feed> feed); ///< to a feed that is there

    const std::shared_ptr<feed::Feed>& feed() const { return feed_; }

private:
    std::shared_ptr<feed::Feed> feed_;
    std::jthread thread_;
};

} // namespace fieldcast::test
