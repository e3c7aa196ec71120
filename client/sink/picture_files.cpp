// SPDX-License-Identifier: Apache-2.0
#include "client/sink/picture_files.h"

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "core/image/look_around.h"
#include "core/image/quilt.h"
#include "core/image/source_frame_exr.h"

#include <chrono>
#include <string>

namespace fieldcast::client::sink {
namespace {

constexpr std::chrono::milliseconds kLookAroundDelay{80}; // a 6×6 border takes 1.6 s

void write_views(const std::filesystem::path& folder, const Picture& picture) {
    for (std::uint32_t row = 0; row < picture.grid.rows; ++row) {
        for (std::uint32_t col = 0; col < picture.grid.cols; ++col) {
            const std::string name = "view_r" + std::to_string(row) + "_c" + std::to_string(col) + ".png";
            image::write_png(folder / name, picture.views.views[row * picture.grid.cols + col].image);
        }
    }
}

void write_quilt(const std::filesystem::path& folder, const Picture& picture) {
    const image::QuiltLayout layout = image::choose_quilt_layout(picture.grid);
    const std::string suffix = image::quilt_suffix(layout, picture.views.views.front().image);
    image::write_png(folder / ("quilt" + suffix + ".png"),
                     image::assemble_quilt(picture.grid, picture.views.views, layout));
}

/// The first source image. All parts of an EXR show the same window, which planes with other sources and layers stacked
/// below would leave.
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

void write_picture(const std::filesystem::path& folder, const Picture& picture, const Products& products) {
    FC_ASSERT(picture.views.views.size() == picture.grid.view_count(), "a picture has all views of its grid");
    std::filesystem::create_directories(folder);
    if (products.views) {
        write_views(folder, picture);
    }
    if (products.quilt) {
        write_quilt(folder, picture);
    }
    if (products.contact_sheet) {
        image::write_png(folder / "contact_sheet.png", image::contact_sheet(picture.grid, picture.views.views));
    }
    if (products.look_around) {
        image::write_look_around(folder / "look_around.png", picture.grid, picture.views.views,
                                 image::SweepPath::kCircle, kLookAroundDelay);
    }
    if (products.source_exr && picture.source != nullptr) {
        image::write_exr(folder / "source.exr", first_image(*picture.source));
    }
}

} // namespace fieldcast::client::sink
