// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/channel_info.h"

#include <optional>
#include <string>

namespace fieldcast::recording {

/// What to record, as it was typed; the channel fills in what was left open.
struct Form {
    enum class Kind : std::uint8_t { kViews, kIllumination, kGBuffer };
    Kind kind = Kind::kViews;
    std::optional<ViewGrid> grid;       ///< rows and columns; unset: the channel's largest
    std::optional<glm::uvec2> size_px;  ///< of a view; unset: the source's
    codec::CodecId codec = codec::CodecId::kZstdFiltered; ///< of views or illumination
    std::uint8_t quality = 0;           ///< of a lossy codec; 0: the channel's

    bool operator==(const Form&) const = default;
};

/// Reads "views", "views:3x3:160x90:jpeg:50", "planes:jpeg", "g-buffer". Empty if malformed.
std::optional<Form> parse_form(const std::string& text);

/// How to write one, for people.
inline constexpr const char* kFormSyntax =
    "write views[:RxC[:WxH]][:raw|zstd|jpeg[:QUALITY]], planes[:raw|zstd|jpeg[:QUALITY]], or g-buffer likewise";

/// What `form` means on that channel. Throws UserError if the channel does not have it.
feed::Wish wish_of(const Form& form, const feed::ChannelInfo& channel);

} // namespace fieldcast::recording
