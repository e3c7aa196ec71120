// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/parallel.h"
#include "server/channel/frame_renderer.h"
#include "server/feed/encoded_frame.h"

namespace fieldcast::channel {

/// Encodes every plane and every view once per codec wanted.
feed::FramePtr encode(const RenderedFrame& frame, WorkerPool& pool);

} // namespace fieldcast::channel
