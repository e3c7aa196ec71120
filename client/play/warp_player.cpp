// SPDX-License-Identifier: Apache-2.0
#include "client/play/warp_player.h"

#include "client/play/view_set_request.h"

namespace fieldcast::client::play {

Decoded<Views> WarpPlayer::play(const SourceFrame& frame, const wire::ViewSet& set) {
    if (const Decoded<void> uploaded = renderer_.upload(frame); !uploaded) {
        return tl::unexpected(uploaded.error());
    }
    return renderer_.render(view_set_request(set));
}

} // namespace fieldcast::client::play
