// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"

#include <array>

namespace fieldcast::bench {

/// A view path traced with many samples, linear. Its remaining noise can be estimated because it consists of two
/// independent halves.
struct ReferencePicture {
    image::RgbF32 mean;                  ///< of all samples
    std::array<image::RgbF32, 2> halves; ///< each of about half of the samples, with independent noise
};

/// A reference without noise.
inline ReferencePicture noiseless(const image::RgbF32& picture) {
    return {picture, {picture, picture}};
}

} // namespace fieldcast::bench
