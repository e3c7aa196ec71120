// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"

#include <string>

namespace fieldcast::bench {

inline constexpr const char* kReferenceName = "reference";

/// A linear picture of one row of a table, or of the reference.
struct NamedPicture {
    std::string name;
    image::RgbF32 linear;
};

} // namespace fieldcast::bench
