// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace fieldcast::access {

/// What the holder of a token may do. Each role includes those before it.
enum class Role : std::uint8_t {
    kView,  ///< look: catalogue, scenes, light fields, health
    kSteer, ///< also move cameras that clients may move
    kAdmin, ///< also operate: metrics, reflection
};

std::optional<Role> parse_role(std::string_view word);
std::string_view to_text(Role role);

/// The least role that may call `method` ("/fieldcast.v1.Catalog/ListChannels"). Unknown methods need kAdmin.
Role needed_role(std::string_view method);

} // namespace fieldcast::access
