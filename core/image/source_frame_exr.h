// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"

#include <filesystem>

namespace fieldcast::image {

/// One EXR part per plane, for inspection and for third-party tools. No plane loses precision:
///
///   part       channels               type    from
///   diffuse    R G B                  HALF    kR11G11B10F (every value is a half)
///   specular   R G B                  HALF    kR11G11B10F
///   depth      Z                      FLOAT   metres along the viewing axis, infinity: nothing hit
///   normal     normal.X, .Y, .Z       FLOAT   world space, unit length
///   id         id                     UINT    instance << 12 | material
///   material   roughness, metallic    HALF
///   colour     R G B                  HALF    linear, the sRGB curve undone
///
/// Each part carries the camera that saw it, guard band included: worldToCamera and the attributes fieldcast:frame_id,
/// scene_time_ns (decimal text, 64 bits), cut, seed, fovy_rad (of the image without band), focal_px, principal_px,
/// guard_band_px (left, right, top, bottom).
///
/// The file appears complete or not at all. Throws std::system_error or std::runtime_error.
void write_exr(const std::filesystem::path& file, const SourceFrame& frame);

} // namespace fieldcast::image
