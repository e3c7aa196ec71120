// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/frame_renderer.h"
#include "server/channel/offline_job.h"

namespace fieldcast::channel {

/// Asked between frames, and between the samples of references, with a text for people; true: stop.
using OfflineProgress = std::function<bool(const std::string& done)>;

/// When frame `frame` of an offline run shows the scene.
FrameMoment offline_moment(const Settings& settings, std::uint32_t frame);

/// Renders frames of a channel as its clients would get them, all views of the largest grid, and writes light fields to
/// files: quilt, views, source EXR; with references, an EXR of linear radiance per view as well. False: stopped; what
/// was written is complete. Throws UserError if the scene is not usable, std::system_error if a file cannot be written.
bool render_offline(const gpu::Device& device, const Settings& settings, const ChannelChoice& channel,
                    const OfflineJob& job, const OfflineProgress& progress);

} // namespace fieldcast::channel
