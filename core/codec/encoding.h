// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/vocabulary.h"

#include <compare>
#include <cstdint>

namespace fieldcast::codec {

/// A codec and its quality.
struct Encoding {
    Codec codec = Codec::kZstdFiltered;
    std::uint8_t quality = 0; ///< of lossy codecs 1 (smallest) to kMaxQuality; 0 of others

    auto operator<=>(const Encoding&) const = default;
};

} // namespace fieldcast::codec
