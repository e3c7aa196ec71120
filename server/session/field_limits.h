// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/configuration.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace fieldcast::session {

/// Limit on the size of one field of Configure that the client may make as large as it likes.
struct FieldLimit {
    std::string_view field; ///< name in Configure, as in Refused.field
    std::size_t most = 0;
    std::string_view unit; ///< of `most`
    std::size_t (*size)(const v1::Configure&) = nullptr; ///< largest occurrence, if the message has several
};

/// Limits of every repeated, string and bytes field of Configure and of its nested messages.
std::span<const FieldLimit> field_limits();

/// The refusal for the first field above its limit. Allocates nothing unless there is one.
std::optional<Refusal> oversized_field(const v1::Configure& wanted);

} // namespace fieldcast::session
