// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/picture_files.h"

#include "core/image/metrics.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::bench {

Plane display_plane(const image::RgbF32& linear, float exposure) {
    Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, linear.width_px, linear.height_px, {}};
    for (const glm::vec3& pixel : image::display_image(linear, exposure).pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            plane.bytes.push_back(static_cast<std::byte>(std::lround(pixel[channel] * 255.0F)));
        }
    }
    return plane;
}

std::string picture_name(const std::string& input, const PictureId& id) {
    std::string folder = input;
    std::ranges::replace(folder, ' ', '_');
    const ViewIndex index = view_index(id.position);
    return folder + "/frame" + std::to_string(id.frame) + "_r" + std::to_string(index.row) + "_c" +
           std::to_string(index.col);
}

void write_picture(const std::filesystem::path& folder, const std::string& name, const image::RgbF32& linear,
                   float exposure) {
    const std::filesystem::path file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    image::write_png(file.string() + ".png", display_plane(linear, exposure));
    image::write_exr(file.string() + ".exr", linear);
}

} // namespace fieldcast::bench
