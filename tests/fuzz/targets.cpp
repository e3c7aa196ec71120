// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>

namespace fieldcast::fuzz {

namespace {

constexpr std::array kTargets{
    Target{"bundle", bundle},
    Target{"cache_entry", cache_entry},
    Target{"client_message", client_message},
    Target{"config", config},
    Target{"environment", environment},
    Target{"frame", frame},
    Target{"gltf", gltf},
    Target{"http_request", http_request},
    Target{"image", image},
    Target{"metrics_page", metrics_page},
    Target{"recording", recording},
    Target{"scenario", scenario},
    Target{"server_message", server_message},
    Target{"strip", strip},
    Target{"token", token},
    Target{"uri", uri},
};

} // namespace

std::span<const Target> all_targets() {
    return kTargets;
}

const Target* find_target(std::string_view name) {
    const auto* const found = std::ranges::find(kTargets, name, &Target::name);
    return found == kTargets.end() ? nullptr : &*found;
}

} // namespace fieldcast::fuzz
