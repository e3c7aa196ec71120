// SPDX-License-Identifier: Apache-2.0
#include "server/access/role.h"

#include <array>

namespace fieldcast::access {

namespace {

constexpr std::array<std::string_view, 3> kWords{"view", "steer", "admin"};
constexpr std::array<std::string_view, 2> kViewServices{"/fieldcast.v1.", "/grpc.health.v1.Health/"};

} // namespace

std::optional<Role> parse_role(std::string_view word) {
    for (std::size_t i = 0; i < kWords.size(); ++i) {
        if (kWords[i] == word) {
            return static_cast<Role>(i);
        }
    }
    return std::nullopt;
}

std::string_view to_text(Role role) {
    return kWords.at(static_cast<std::size_t>(role));
}

Role needed_role(std::string_view method) {
    for (const std::string_view service : kViewServices) {
        if (method.starts_with(service)) {
            return Role::kView;
        }
    }
    return Role::kAdmin;
}

} // namespace fieldcast::access
