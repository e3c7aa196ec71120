// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"
#include "core/lightfield/views.h"

#include <filesystem>

namespace fieldcast::image {

/// Files to write for a picture.
struct LightFieldProducts {
    bool quilt = true;          ///< quilt_qs{cols}x{rows}a{aspect}.png, view 0 bottom left
    bool views = true;          ///< view_r{row}_c{col}.png, row 0 on top
    bool contact_sheet = false; ///< contact_sheet.png, all views as the grid has them, with gaps
    bool look_around = false;   ///< look_around.png, an animation that sweeps the views
    bool source_exr = false;    ///< source.exr, one part per plane, without the layers of BLEND surfaces
};

/// One light field: the views of `grid`, row-major, all of one size.
struct LightFieldPicture {
    const ViewGrid& grid;
    const Views& views;
    const SourceFrame* source; ///< null: there is no source.exr
};

/// Writes the products into `folder`, which is created. Every file appears complete or not at all.
/// Throws std::system_error.
void write_light_field(const std::filesystem::path& folder, const LightFieldPicture& picture,
                       const LightFieldProducts& products);

} // namespace fieldcast::image
