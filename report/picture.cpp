// SPDX-License-Identifier: Apache-2.0
// Colours of errors: control points of "magma" by S. van der Walt and N. Smith (matplotlib, CC0).
#include "report/picture.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fieldcast::report {

namespace {

constexpr std::size_t kMostPictures = 16;
const std::array<glm::vec3, 6> kMagma{glm::vec3(0, 0, 4) / 255.0F,       glm::vec3(59, 15, 112) / 255.0F,
                                      glm::vec3(140, 41, 129) / 255.0F,  glm::vec3(222, 73, 104) / 255.0F,
                                      glm::vec3(254, 159, 109) / 255.0F, glm::vec3(252, 253, 191) / 255.0F};

glm::vec3 magma(float share) {
    const float place = std::clamp(share, 0.0F, 1.0F) * static_cast<float>(kMagma.size() - 1);
    const auto index = std::min(static_cast<std::size_t>(place), kMagma.size() - 2);
    return glm::mix(kMagma[index], kMagma[index + 1], place - static_cast<float>(index));
}

std::string data_uri(const image::RgbF32& display) {
    Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, display.width_px, display.height_px, {}};
    for (const glm::vec3& pixel : display.pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            plane.bytes.push_back(static_cast<std::byte>(std::lround(std::clamp(pixel[channel], 0.0F, 1.0F) * 255.0F)));
        }
    }
    return "data:image/png;base64," + base64(image::encode_png(plane));
}

/// An image drawn by the rule of picture `index`.
Markup drawn(std::size_t index, const std::string& label) {
    return {joined({"<div class=\"picture p", std::to_string(index), "\" role=\"img\" aria-label=\"", escaped(label),
                    "\"></div>"})};
}

Markup viewer(const std::vector<Picture>& pictures) {
    Markup content;
    Markup stage;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const std::string id = joined({"picture", std::to_string(i)});
        content += Markup{joined({"<input type=\"radio\" name=\"picture\" id=\"", id, "\"", i == 0 ? " checked" : "",
                                  "><label for=\"", id, "\">", escaped(pictures[i].label), "</label>"})};
        stage += drawn(i, pictures[i].label);
    }
    content += element("div", "stage", stage);
    return element("figure", "viewer", content);
}

double squared_sum(const image::RgbF32& errors, const Crop& crop) {
    double sum = 0.0;
    for (std::uint32_t y = crop.y; y < crop.y + crop.height; ++y) {
        for (std::uint32_t x = crop.x; x < crop.x + crop.width; ++x) {
            const glm::vec3& error = errors.pixels[std::size_t{y} * errors.width_px + x];
            sum += static_cast<double>(glm::dot(error, error));
        }
    }
    return sum;
}

} // namespace

Crop worst_crop(const image::RgbF32& errors, std::uint32_t width, std::uint32_t height) {
    Crop best{0, 0, std::min(width, errors.width_px), std::min(height, errors.height_px)};
    double most = -1.0;
    Crop crop = best;
    const std::uint32_t last_x = errors.width_px - crop.width;
    const std::uint32_t last_y = errors.height_px - crop.height;
    const std::uint32_t step_x = std::max(1U, crop.width / 2);
    const std::uint32_t step_y = std::max(1U, crop.height / 2);
    for (std::uint32_t row = 0; row < last_y + step_y; row += step_y) {
        for (std::uint32_t col = 0; col < last_x + step_x; col += step_x) {
            crop.x = std::min(col, last_x);
            crop.y = std::min(row, last_y);
            const double sum = squared_sum(errors, crop);
            if (sum > most) {
                most = sum;
                best = crop;
            }
        }
    }
    return best;
}

image::RgbF32 cropped(const image::RgbF32& image, const Crop& crop) {
    FC_ASSERT(crop.x + crop.width <= image.width_px && crop.y + crop.height <= image.height_px, "the crop lies inside");
    image::RgbF32 result{crop.width, crop.height, {}};
    for (std::uint32_t y = 0; y < crop.height; ++y) {
        const auto row =
            image.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{crop.y + y} * image.width_px + crop.x);
        result.pixels.insert(result.pixels.end(), row, row + static_cast<std::ptrdiff_t>(crop.width));
    }
    return result;
}

image::RgbF32 error_map(const image::RgbF32& errors, float largest) {
    image::RgbF32 result = errors;
    for (glm::vec3& pixel : result.pixels) {
        const glm::vec3 error = glm::abs(pixel);
        pixel = magma((error.r + error.g + error.b) / (3.0F * largest));
    }
    return result;
}

Markup error_scale(float largest) {
    std::string stops;
    for (const glm::vec3& colour : kMagma) {
        const auto value = [&](int channel) { return std::to_string(std::lround(colour[channel] * 255.0F)); };
        stops += joined({",rgb(", value(0), ",", value(1), ",", value(2), ")"});
    }
    Markup scale{joined({"<div class=\"scale\" style=\"background:linear-gradient(to right", stops, ")\"></div>\n"})};
    Markup ends = element("span", "", text("no error"));
    ends += element("span", "", text(fixed(static_cast<double>(largest), 2) + " and more"));
    scale += element("div", "ends", ends);
    return scale;
}

Markup compare_pictures(Page& page, const std::vector<Picture>& pictures) {
    FC_ASSERT(!pictures.empty() && pictures.size() <= kMostPictures, "1 … 16 pictures");
    Markup list;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const image::RgbF32& display = pictures[i].display;
        const std::string n = std::to_string(i + 1);
        page.add_style(joined({".p", std::to_string(i), "{background-image:url(", data_uri(display), ");aspect-ratio:",
                               std::to_string(display.width_px), "/", std::to_string(display.height_px), "}\n"}));
        page.add_style(
            joined({".viewer input:nth-of-type(", n, "):checked ~ .stage > :nth-child(", n, "){display:block}\n"}));
        Markup entry = drawn(i, pictures[i].label);
        entry += element("span", "", text(pictures[i].label));
        entry += element("span", "numbers-of", text(pictures[i].numbers));
        list += element("div", pictures[i].begins_row ? "first" : "", entry);
    }
    Markup content = viewer(pictures);
    content += element("div", "pictures", list);
    return content;
}

} // namespace fieldcast::report
