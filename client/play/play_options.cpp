// SPDX-License-Identifier: Apache-2.0
#include "client/play/play_options.h"

#include <algorithm>

namespace fieldcast::client::play {

bool asks_for(const PlayOptions& options, DeliveryMode mode) {
    return options.request.mode == mode ||
           std::ranges::any_of(options.changes, [&](const Change& change) { return change.request.mode == mode; });
}

bool needs_scene(const PlayOptions& options) {
    const bool may_adapt = options.request.adaptation && options.request.adaptation->allows_scene;
    return may_adapt || std::ranges::any_of(kAll<DeliveryMode>, [&](DeliveryMode mode) {
               return row_of(mode).needs_scene && asks_for(options, mode);
           });
}

} // namespace fieldcast::client::play
