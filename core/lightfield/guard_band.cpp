// SPDX-License-Identifier: Apache-2.0
// Chooses the guard band by counting, for each pixel around the source image, the views that need it.
//
// A pixel x of the widened source at depth z lies in view Δ at x − Δ·d(z). If that is inside the view while x is
// outside the source image, the view has an out-of-frustum pixel there, which a band reaching to x removes.
// Approximations: occlusion is ignored (points that a nearer surface hides count, too), and each point counts once
// although a view may see it magnified. Both concern the share, not the direction in which the band grows.
#include "core/lightfield/guard_band.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fieldcast {

namespace {

/// Part of the widened image: columns x0 … x1−1, rows y0 … y1−1.
struct Rectangle {
    std::uint32_t x0 = 0;
    std::uint32_t x1 = 0;
    std::uint32_t y0 = 0;
    std::uint32_t y1 = 0;

    bool contains(std::uint32_t x, std::uint32_t y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
    std::uint64_t area() const { return static_cast<std::uint64_t>(x1 - x0) * (y1 - y0); }
};

/// Offsets of the views from `at` along one axis, times f·b. Multiplied by 1/z − 1/z_c they are displacements in
/// pixels.
std::vector<float> displacements(const Camera& source, const ViewGrid& grid, LatticePosition at, bool is_horizontal) {
    std::vector<float> result;
    const std::uint32_t count = is_horizontal ? grid.cols : grid.rows;
    const float spacing_m = is_horizontal ? grid.geometry.spacing_m.x : grid.geometry.spacing_m.y;
    for (std::uint32_t i = 0; i < count; ++i) {
        const LatticePosition position = lattice_position(grid, is_horizontal ? 0 : i, is_horizontal ? i : 0);
        const float steps = is_horizontal ? position.col() - at.col() : position.row() - at.row();
        result.push_back(steps * spacing_m * source.focal_px);
    }
    return result;
}

/// Number of views that see, between 0 and `size_px`, a point at `source_px` of the source.
std::uint32_t count_inside(const std::vector<float>& displacements_px_m, float inverse_depth, float source_px,
                           float size_px) {
    std::uint32_t count = 0;
    for (const float displacement : displacements_px_m) {
        const float target_px = source_px - displacement * inverse_depth;
        count += target_px >= 0.0F && target_px < size_px ? 1U : 0U;
    }
    return count;
}

/// Sums of view counts over rectangles of the widened image, in constant time.
class NeedTable {
public:
    NeedTable(std::uint32_t width_px, std::uint32_t height_px)
        : stride_(width_px + 1), sums_(static_cast<std::size_t>(stride_) * (height_px + 1)) {}

    /// Rows must be added from top to bottom.
    void add_row(std::uint32_t y, std::span<const std::uint32_t> needs) {
        std::uint64_t row_sum = 0;
        for (std::size_t x = 0; x < needs.size(); ++x) {
            row_sum += needs[x];
            sums_[(y + 1) * stride_ + x + 1] = sums_[y * stride_ + x + 1] + row_sum;
        }
    }

    std::uint64_t sum(const Rectangle& r) const {
        return sums_[r.y1 * stride_ + r.x1] + sums_[r.y0 * stride_ + r.x0] - sums_[r.y1 * stride_ + r.x0] -
               sums_[r.y0 * stride_ + r.x1];
    }

private:
    std::size_t stride_;
    std::vector<std::uint64_t> sums_;
};

NeedTable count_needs(const Camera& source, const Camera& widened, const Rectangle& image,
                      std::span<const float> depth_m, const ViewGrid& grid, LatticePosition at) {
    const std::vector<float> across = displacements(source, grid, at, true);
    const std::vector<float> down = displacements(source, grid, at, false);
    const auto width = static_cast<float>(source.width_px);
    const auto height = static_cast<float>(source.height_px);
    NeedTable table(widened.width_px, widened.height_px);
    std::vector<std::uint32_t> needs(widened.width_px);
    for (std::uint32_t y = 0; y < widened.height_px; ++y) {
        const float source_y = static_cast<float>(y) + 0.5F - static_cast<float>(image.y0);
        for (std::uint32_t x = 0; x < widened.width_px; ++x) {
            const float depth = depth_m[static_cast<std::size_t>(y) * widened.width_px + x];
            needs[x] = 0;
            if (image.contains(x, y) || !(depth > 0.0F)) {
                continue;
            }
            const float inverse_depth = 1.0F / depth - 1.0F / grid.geometry.convergence_m;
            const float source_x = static_cast<float>(x) + 0.5F - static_cast<float>(image.x0);
            const std::uint32_t rows = count_inside(down, inverse_depth, source_y, height);
            needs[x] = rows == 0 ? 0 : rows * count_inside(across, inverse_depth, source_x, width);
        }
        table.add_row(y, needs);
    }
    return table;
}

enum class Side : std::uint8_t { kLeft, kRight, kTop, kBottom };
constexpr std::array kSides{Side::kLeft, Side::kRight, Side::kTop, Side::kBottom};

Rectangle grown(Rectangle r, Side side, std::uint32_t by_px) {
    switch (side) {
    case Side::kLeft:
        r.x0 -= by_px;
        break;
    case Side::kRight:
        r.x1 += by_px;
        break;
    case Side::kTop:
        r.y0 -= by_px;
        break;
    case Side::kBottom:
        r.y1 += by_px;
        break;
    }
    return r;
}

std::uint32_t room(const Rectangle& r, Side side, const Camera& widened) {
    switch (side) {
    case Side::kLeft:
        return r.x0;
    case Side::kRight:
        return widened.width_px - r.x1;
    case Side::kTop:
        return r.y0;
    case Side::kBottom:
        return widened.height_px - r.y1;
    }
    return 0;
}

/// Largest ratio of removed pixels to added source pixels over all widths by which `side` may grow. Looking at all
/// widths steps over strips that no view needs, such as sky in front of a near wall.
double best_density(const NeedTable& table, const Rectangle& r, Side side, std::uint32_t room_px) {
    const auto now = static_cast<double>(table.sum(r));
    double best = 0.0;
    for (std::uint32_t by_px = 1; by_px <= room_px; ++by_px) {
        const Rectangle wider = grown(r, side, by_px);
        const double added = static_cast<double>(wider.area() - r.area());
        best = std::max(best, (static_cast<double>(table.sum(wider)) - now) / added);
    }
    return best;
}

/// Grows `r` by one pixel on the side with the best density that stays within `max_area`. Returns false if none does.
bool grow_once(Rectangle& r, const NeedTable& table, const Camera& widened, double max_area) {
    double best = 0.0;
    Rectangle best_rectangle = r;
    for (const Side side : kSides) {
        const std::uint32_t room_px = room(r, side, widened);
        if (room_px == 0 || static_cast<double>(grown(r, side, 1).area()) > max_area) {
            continue;
        }
        const double density = best_density(table, r, side, room_px);
        if (density > best) {
            best = density;
            best_rectangle = grown(r, side, 1);
        }
    }
    r = best_rectangle;
    return best > 0.0;
}

std::uint32_t band_px(float least_px, std::uint32_t image_px) {
    return static_cast<std::uint32_t>(std::min(std::ceil(std::max(least_px, 0.0F)), static_cast<float>(image_px / 2)));
}

/// Largest and smallest Δ·d over the views and over depths from the nearest to infinity.
struct Reach {
    float most_px = 0.0F;
    float least_px = 0.0F;
};

Reach reach(const std::vector<float>& displacements_px_m, float nearest_m, float convergence_m) {
    Reach result;
    for (const float displacement : displacements_px_m) {
        for (const float inverse_depth : {1.0F / nearest_m - 1.0F / convergence_m, -1.0F / convergence_m}) {
            result.most_px = std::max(result.most_px, displacement * inverse_depth);
            result.least_px = std::min(result.least_px, displacement * inverse_depth);
        }
    }
    return result;
}

} // namespace

GuardBandChoice choose_guard_band(const Camera& source, const GuardBand& widest, std::span<const float> depth_m,
                                  const ViewGrid& largest, double target_share, double max_extra_share,
                                  LatticePosition at) {
    const Camera widened = with_guard_band(source, widest);
    FC_ASSERT(depth_m.size() == static_cast<std::size_t>(widened.width_px) * widened.height_px,
              "depth image has the size of the widened camera");
    const Rectangle image{widest.left_px, widest.left_px + source.width_px, widest.top_px,
                          widest.top_px + source.height_px};
    const NeedTable table = count_needs(source, widened, image, depth_m, largest, at);
    const auto total = static_cast<double>(table.sum({0, widened.width_px, 0, widened.height_px}));
    const auto image_area = static_cast<double>(image.area());
    const double max_area = image_area * (1.0 + max_extra_share);

    Rectangle chosen = image;
    while (static_cast<double>(table.sum(chosen)) < target_share * total &&
           grow_once(chosen, table, widened, max_area)) {
    }
    GuardBandChoice choice;
    choice.band = {image.x0 - chosen.x0, chosen.x1 - image.x1, image.y0 - chosen.y0, chosen.y1 - image.y1};
    choice.removed_share = total > 0.0 ? static_cast<double>(table.sum(chosen)) / total : 1.0;
    choice.extra_share = static_cast<double>(chosen.area()) / image_area - 1.0;
    return choice;
}

GuardBand widest_guard_band(const Camera& source, const ViewGrid& grid, float nearest_m, LatticePosition at) {
    FC_ASSERT(nearest_m > 0.0F, "depths are positive");
    const Reach across = reach(displacements(source, grid, at, true), nearest_m, grid.geometry.convergence_m);
    const Reach down = reach(displacements(source, grid, at, false), nearest_m, grid.geometry.convergence_m);
    return {band_px(-across.least_px, source.width_px), band_px(across.most_px, source.width_px),
            band_px(-down.least_px, source.height_px), band_px(down.most_px, source.height_px)};
}

} // namespace fieldcast
