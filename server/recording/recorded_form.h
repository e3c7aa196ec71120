// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"

#include <optional>
#include <string>

namespace fieldcast::recording {

/// One form to record, as the user wrote it; the channel supplies the values that are unset.
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

/// Syntax of a form, as text for people: "views[:RxC[:WxH]][:CODEC[:QUALITY]] …".
std::string form_syntax();

/// The selection that `form` stands for on that channel. Throws UserError if the channel does not offer it.
feed::Selection selection_of(const RecordedForm& form, const feed::ChannelInfo& channel);

} // namespace fieldcast::recording
