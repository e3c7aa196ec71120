// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/camera/own_cameras.h"
#include "server/channel/channel.h"

#include <memory>

namespace fieldcast::channel {

/// A channel that gives every client a camera: loads the scene and settles what all of them share, measures what frames
/// take, and lets go of the device until somebody comes. What `shared` refers to and `cameras` must outlive every feed
/// that is opened. Throws UserError if the scene is not usable.
std::shared_ptr<feed::Feed> open_own_channel(const Channel::Shared& shared, const ChannelChoice& choice,
                                             camera::OwnCameras& cameras);

} // namespace fieldcast::channel
