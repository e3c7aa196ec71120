// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/camera/own_cameras.h"
#include "server/channel/channel.h"

#include <memory>

namespace fieldcast::channel {

/// A channel that gives every client a camera. Loads the scene, settles what all cameras share, measures the cost of a
/// frame, and frees its device memory until a client arrives. `cameras` and the references in `shared` must outlive
/// every opened feed. Throws UserError if the scene is not usable.
std::shared_ptr<feed::Feed> open_own_channel(const Channel::Shared& shared, const ChannelChoice& choice,
                                             camera::OwnCameras& cameras);

} // namespace fieldcast::channel
