// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace fieldcast::access {

/// Permissions of a token. Each role includes those before it.
enum class Role : std::uint8_t {
    kView,  ///< reads catalogue, scenes, light fields and health
    kSteer, ///< also steers cameras of channels that allow it
    kAdmin, ///< also reads metrics and reflection
};

std::optional<Role> parse_role(std::string_view word);
std::string_view to_text(Role role);

/// The lowest role that may call `method` ("/fieldcast.v1.Catalog/ListChannels"). Unknown methods need kAdmin.
Role needed_role(std::string_view method);

} // namespace fieldcast::access
