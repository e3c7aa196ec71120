// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/picture_id.h"
#include "core/image/image_file.h"

#include <filesystem>
#include <string>

namespace fieldcast::bench {

/// An 8-bit display-referred image of linear radiance.
Plane display_plane(const image::RgbF32& linear, float exposure);

/// Path of a picture in the folder of a result, without extension: "svgf/frame29_r0_c5". Spaces become underscores.
std::string picture_name(const std::string& input, const PictureId& id);

/// Writes NAME.png, display-referred, and NAME.exr, linear and unexposed. Throws std::system_error.
void write_picture(const std::filesystem::path& folder, const std::string& name, const image::RgbF32& linear,
                   float exposure);

} // namespace fieldcast::bench
