// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/negotiate.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace fieldcast::session {

/// How much a Configure may have of one field whose size is the client's choice.
struct FieldLimit {
    std::string_view field; ///< of Configure, as in Refused.field
    std::size_t most = 0;
    std::string_view unit; ///< of `most`
    std::size_t (*size)(const v1::Configure&) = nullptr; ///< the largest one, if the message has several
};

/// Every repeated field, string and bytes field of Configure and of the messages in it.
std::span<const FieldLimit> field_limits();

/// The first field that is larger than it may be. Allocates nothing unless there is one.
std::optional<Refusal> oversized_field(const v1::Configure& wanted);

} // namespace fieldcast::session
