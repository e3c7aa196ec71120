// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"

#include <optional>
#include <string>

namespace fieldcast::recording {

/// What to record, as it was typed; the channel fills in what was left open.
struct RecordedForm {
    DeliveryMode mode = DeliveryMode::kViews;
    PlaneSet set = PlaneSet::kIllumination; ///< of modes that need the scene
    std::optional<ViewGrid> grid;           ///< rows and columns; unset: the channel's largest
    std::optional<glm::uvec2> size_px;      ///< of a view; unset: the source's
    Codec codec = Codec::kZstdFiltered;     ///< of planes that it can carry
    std::uint8_t quality = 0;               ///< of a lossy codec; 0: the channel's

    bool operator==(const RecordedForm&) const = default;
};

/// Reads "views", "views:3x3:160x90:jpeg:50", "illumination:jpeg", "g-buffer", "warp". Empty if malformed.
std::optional<RecordedForm> parse_form(const std::string& text);

/// How to write one, for people: "views[:RxC[:WxH]][:CODEC[:QUALITY]] …".
std::string form_syntax();

/// What `form` means on that channel. Throws UserError if the channel does not have it.
feed::Selection selection_of(const RecordedForm& form, const feed::ChannelInfo& channel);

} // namespace fieldcast::recording
