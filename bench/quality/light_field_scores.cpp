// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/light_field_scores.h"

#include "bench/quality/scores.h"
#include "core/base/error.h"
#include "core/image/epipolar.h"
#include "core/image/metrics.h"
#include "core/image/refocus.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::bench {

namespace {

constexpr std::size_t kFocalDepths = 5;

using Images = std::vector<image::RgbF32>;

Images displayed(const Images& linear, float exposure) {
    Images result;
    for (const image::RgbF32& image : linear) {
        result.push_back(image::display_image(image, exposure));
    }
    return result;
}

/// Linear light that a display emits: exposed and clamped to its range.
Images emitted(Images linear, float exposure) {
    for (image::RgbF32& image : linear) {
        for (glm::vec3& pixel : image.pixels) {
            pixel = glm::clamp(pixel * exposure, 0.0F, 1.0F);
        }
    }
    return linear;
}

nlohmann::ordered_json to_json(const std::vector<double>& values) {
    const Spread spread = spread_of(values);
    return {{"mean", spread.mean}, {"min", spread.min}, {"max", spread.max}, {"deviation", spread.deviation}};
}

void add_views(nlohmann::ordered_json& json, const ViewGrid& grid, const Images& views, const Images& references) {
    std::vector<double> rmse;
    std::vector<double> ssim;
    for (std::size_t i = 0; i < views.size(); ++i) {
        rmse.push_back(image::rmse(views[i], references[i]));
        ssim.push_back(image::ssim(views[i], references[i]));
        json["views"].push_back({{"row", i / grid.cols}, {"col", i % grid.cols}, {"rmse", rmse[i]}, {"ssim", ssim[i]}});
    }
    json["rmse"] = to_json(rmse);
    json["ssim"] = to_json(ssim);
}

nlohmann::ordered_json angular_error(const ViewGrid& grid, const Images& views, const Images& references,
                                     const std::vector<image::ViewSurfaces>& surfaces) {
    Images errors;
    for (std::size_t i = 0; i < views.size(); ++i) {
        errors.push_back(image::error_image(views[i], references[i]));
    }
    std::vector<double> differences;
    const auto compare = [&](std::size_t view, std::size_t neighbour) {
        const image::Correspondence map = image::find_correspondence(surfaces[view], surfaces[neighbour]);
        if (const auto difference = image::warped_difference(errors[view], errors[neighbour], map)) {
            differences.push_back(*difference);
        }
    };
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (i % grid.cols > 0) {
            compare(i, i - 1);
        }
        if (i >= grid.cols) {
            compare(i, i - grid.cols);
        }
    }
    return differences.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(spread_of(differences).mean);
}

/// Mean over the rows and columns of views.
nlohmann::ordered_json epi_ssim_of(const ViewGrid& grid, const Images& views, const Images& references) {
    std::vector<double> values;
    for (std::size_t row = 0; grid.cols >= 2 && row < grid.rows; ++row) {
        values.push_back(image::epi_ssim(std::span(views).subspan(row * grid.cols, grid.cols),
                                         std::span(references).subspan(row * grid.cols, grid.cols),
                                         image::ViewLine::kRow));
    }
    for (std::size_t col = 0; grid.rows >= 2 && col < grid.cols; ++col) {
        Images column;
        Images column_references;
        for (std::size_t row = 0; row < grid.rows; ++row) {
            column.push_back(views[row * grid.cols + col]);
            column_references.push_back(references[row * grid.cols + col]);
        }
        values.push_back(image::epi_ssim(column, column_references, image::ViewLine::kColumn));
    }
    return values.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(spread_of(values).mean);
}

/// `views` in linear light, focused at `depth_m` as seen by the source camera; display-referred.
image::RgbF32 focused(const ViewGrid& grid, const Images& views, float focal_px, float depth_m) {
    const auto positions = lattice_positions(grid);
    std::vector<image::ShiftedView> shifted;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto disparity = [&](float spacing_m) {
            return disparity_px(focal_px, spacing_m, depth_m, grid.geometry.convergence_m);
        };
        // x_source = x_target + column · disparity (docs/lightfield.md), so the point is further left by this amount.
        shifted.push_back({&views[i],
                           {-positions[i].col() * disparity(grid.geometry.spacing_m.x),
                            -positions[i].row() * disparity(grid.geometry.spacing_m.y)}});
    }
    return image::display_image(image::refocus(shifted), 1.0F);
}

void add_refocus(nlohmann::ordered_json& json, const ViewGrid& grid, const LightFieldPictures& pictures,
                 float exposure) {
    const auto positions = lattice_positions(grid);
    const auto source = std::ranges::find(positions, LatticePosition{});
    const std::size_t middle = source != positions.end() ? static_cast<std::size_t>(source - positions.begin()) : 0;
    const image::ViewSurfaces& seen = pictures.surfaces[middle];
    const Images views = emitted(pictures.views, exposure);
    const Images references = emitted(pictures.references, exposure);
    std::vector<double> rmse;
    std::vector<double> ssim;
    for (const float depth_m : image::focal_depths(seen.depth_m, kFocalDepths)) {
        const image::RgbF32 image = focused(grid, views, seen.camera.focal_px, depth_m);
        const image::RgbF32 expected = focused(grid, references, seen.camera.focal_px, depth_m);
        rmse.push_back(image::rmse(image, expected));
        ssim.push_back(image::ssim(image, expected));
        const nlohmann::ordered_json depth = std::isfinite(depth_m) ? nlohmann::ordered_json(depth_m) : nullptr;
        json["refocus"].push_back({{"depth_m", depth}, {"rmse", rmse.back()}, {"ssim", ssim.back()}});
    }
    json["refocus_rmse"] = spread_of(rmse).mean;
    json["refocus_ssim"] = spread_of(ssim).mean;
}

} // namespace

nlohmann::ordered_json light_field_scores(const ViewGrid& grid, const LightFieldPictures& pictures, float exposure) {
    FC_ASSERT(pictures.views.size() == grid.view_count() && pictures.references.size() == grid.view_count() &&
                  pictures.surfaces.size() == grid.view_count(),
              "every view of the grid is there");
    const Images views = displayed(pictures.views, exposure);
    const Images references = displayed(pictures.references, exposure);
    nlohmann::ordered_json json;
    add_views(json, grid, views, references);
    json["angular_error"] = angular_error(grid, views, references, pictures.surfaces);
    json["epi_ssim"] = epi_ssim_of(grid, views, references);
    add_refocus(json, grid, pictures, exposure);
    return json;
}

} // namespace fieldcast::bench
