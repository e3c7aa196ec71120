// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/frame_renderer.h"
#include "server/channel/offline_job.h"

namespace fieldcast::channel {

/// Called between frames, and between samples of references, with a text for people. True: stop.
using OfflineProgress = std::function<bool(const std::string& done)>;

/// Scene time of frame number `frame` of an offline run.
FrameMoment offline_moment(const Settings& settings, std::uint32_t frame);

/// Renders frames as clients of the channel would get them, with all views of the largest grid, and writes them to
/// files: quilt, views, source EXR; for references also an EXR of linear radiance per view. False: stopped; the written
/// files are complete. Throws UserError if the scene is not usable, std::system_error if a file cannot be written.
bool render_offline(const gpu::Device& device, const Settings& settings, const ChannelChoice& channel,
                    const OfflineJob& job, const OfflineProgress& progress);

} // namespace fieldcast::channel
