// SPDX-License-Identifier: Apache-2.0
#include "core/image/light_field_files.h"

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "core/image/look_around.h"
#include "core/image/quilt.h"
#include "core/image/source_frame_exr.h"

#include <chrono>
#include <string>

namespace fieldcast::image {
namespace {

constexpr std::chrono::milliseconds kLookAroundDelay{80}; // a 6×6 border takes 1.6 s

void write_views(const std::filesystem::path& folder, const LightFieldPicture& picture) {
    for (std::uint32_t row = 0; row < picture.grid.rows; ++row) {
        for (std::uint32_t col = 0; col < picture.grid.cols; ++col) {
            const std::string name = "view_r" + std::to_string(row) + "_c" + std::to_string(col) + ".png";
            write_png(folder / name, picture.views.views[row * picture.grid.cols + col].image);
        }
    }
}

void write_quilt(const std::filesystem::path& folder, const LightFieldPicture& picture) {
    const QuiltLayout layout = choose_quilt_layout(picture.grid);
    const std::string suffix = quilt_suffix(layout, picture.views.views.front().image);
    write_png(folder / ("quilt" + suffix + ".png"), assemble_quilt(picture.grid, picture.views.views, layout));
}

/// The first source image. All parts of an EXR have the same window, which planes with further sources and layers
/// stacked below would exceed.
SourceFrame first_image(const SourceFrame& source) {
    SourceFrame image;
    image.header = source.header;
    image.header.layer_count = 0;
    image.header.source_positions.resize(1);
    for (const Plane& plane : source.planes) {
        Plane first = plane;
        first.height_px = plane_height(image.header, plane.semantic);
        first.bytes.resize(plane_bytes(first.format, first.width_px, first.height_px));
        image.planes.push_back(std::move(first));
    }
    return image;
}

} // namespace

void write_light_field(const std::filesystem::path& folder, const LightFieldPicture& picture,
                       const LightFieldProducts& products) {
    FC_ASSERT(picture.views.views.size() == picture.grid.view_count(), "a picture has all views of its grid");
    std::filesystem::create_directories(folder);
    if (products.views) {
        write_views(folder, picture);
    }
    if (products.quilt) {
        write_quilt(folder, picture);
    }
    if (products.contact_sheet) {
        write_png(folder / "contact_sheet.png", contact_sheet(picture.grid, picture.views.views));
    }
    if (products.look_around) {
        write_look_around(folder / "look_around.png", picture.grid, picture.views.views,
                                 SweepPath::kCircle, kLookAroundDelay);
    }
    if (products.source_exr && picture.source != nullptr) {
        write_exr(folder / "source.exr", first_image(*picture.source));
    }
}

} // namespace fieldcast::image
