// SPDX-License-Identifier: Apache-2.0
// Cameras, grids and view sets. convert_header.cpp has frame headers, convert_settings.cpp everything else.
#include "core/wire/convert.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace fieldcast::wire {

namespace {

constexpr int kCameraFloats = 12;
constexpr float kMaxPositionM = 1e9F;
constexpr float kMaxPixels = 1e6F;
constexpr float kRigidTolerance = 1e-3F; // of dot products; float rounding of a rotation is below 1e-6

bool is_side(std::uint32_t pixels) {
    return pixels >= 1 && pixels <= kMaxPlaneSide;
}

bool is_rigid(const glm::mat4& m) {
    const glm::mat3 rotation(m);
    const glm::mat3 product = glm::transpose(rotation) * rotation;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (!(std::abs(product[i][j] - (i == j ? 1.0F : 0.0F)) <= kRigidTolerance)) {
                return false;
            }
        }
    }
    return glm::determinant(rotation) > 0.0F;
}

} // namespace

void to_proto(const Camera& camera, v1::PinholeCamera& message) {
    message.clear_world_from_camera();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            message.add_world_from_camera(camera.world_from_camera[column][row]);
        }
    }
    message.set_focal_px(camera.focal_px);
    message.set_principal_x_px(camera.principal_px.x);
    message.set_principal_y_px(camera.principal_px.y);
    message.set_width_px(camera.width_px);
    message.set_height_px(camera.height_px);
}

Decoded<glm::mat4> pose_from_proto(const google::protobuf::RepeatedField<float>& values) {
    if (values.size() != kCameraFloats) {
        return decode_error("camera.world_from_camera: " + std::to_string(values.size()) + " values, not 12");
    }
    glm::mat4 pose(1.0F);
    for (int i = 0; i < kCameraFloats; ++i) {
        const float value = values[i];
        if (!(std::abs(value) <= kMaxPositionM)) {
            return decode_error("camera.world_from_camera: not finite or beyond 1e9 m");
        }
        pose[i / 3][i % 3] = value;
    }
    if (!is_rigid(pose)) {
        return decode_error("camera.world_from_camera: not a rotation");
    }
    return pose;
}

Decoded<Camera> from_proto(const v1::PinholeCamera& message) {
    const auto pose = pose_from_proto(message.world_from_camera());
    if (!pose) {
        return tl::unexpected(pose.error());
    }
    Camera camera;
    camera.world_from_camera = *pose;
    camera.focal_px = message.focal_px();
    camera.principal_px = {message.principal_x_px(), message.principal_y_px()};
    if (!(camera.focal_px > 0.0F && camera.focal_px <= kMaxPixels)) {
        return decode_error("camera.focal_px: must be above 0 and at most 1e6");
    }
    if (!(std::abs(camera.principal_px.x) <= kMaxPixels && std::abs(camera.principal_px.y) <= kMaxPixels)) {
        return decode_error("camera.principal_px: not finite or beyond 1e6");
    }
    camera.width_px = message.width_px();
    camera.height_px = message.height_px();
    if (!is_side(camera.width_px) || !is_side(camera.height_px)) {
        return decode_error("camera: " + std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px) +
                            " pixels, sides are 1 to 16384");
    }
    return camera;
}

void to_proto(const GuardBand& band, v1::GuardBand& message) {
    message.set_left_px(band.left_px);
    message.set_right_px(band.right_px);
    message.set_top_px(band.top_px);
    message.set_bottom_px(band.bottom_px);
}

Decoded<GuardBand> from_proto(const v1::GuardBand& message) {
    const GuardBand band{message.left_px(), message.right_px(), message.top_px(), message.bottom_px()};
    if (band.left_px > kMaxPlaneSide || band.right_px > kMaxPlaneSide || band.top_px > kMaxPlaneSide ||
        band.bottom_px > kMaxPlaneSide) {
        return decode_error("guard_band: more than 16384 pixels");
    }
    return band;
}

void to_proto(const ViewGrid& grid, v1::Grid& message) {
    message.set_rows(grid.rows);
    message.set_cols(grid.cols);
    message.set_spacing_x_m(grid.geometry.spacing_m.x);
    message.set_spacing_y_m(grid.geometry.spacing_m.y);
    message.set_convergence_m(std::isinf(grid.geometry.convergence_m) ? 0.0F : grid.geometry.convergence_m);
    message.set_anchor(grid.anchor == Anchor::kCentre ? v1::ANCHOR_CENTRE : v1::ANCHOR_LATTICE);
}

Decoded<ViewGrid> from_proto(const v1::Grid& message, const LatticeGeometry& channel) {
    ViewGrid grid{message.rows(), message.cols(), channel, Anchor::kLattice};
    if (message.has_spacing_x_m()) {
        grid.geometry.spacing_m.x = message.spacing_x_m();
    }
    if (message.has_spacing_y_m()) {
        grid.geometry.spacing_m.y = message.spacing_y_m();
    }
    if (message.has_convergence_m()) {
        const float asked_m = message.convergence_m();
        grid.geometry.convergence_m = asked_m == 0.0F ? std::numeric_limits<float>::infinity() : asked_m;
    }
    switch (static_cast<int>(message.anchor())) {
    case v1::ANCHOR_UNSPECIFIED:
    case v1::ANCHOR_LATTICE:
        break;
    case v1::ANCHOR_CENTRE:
        grid.anchor = Anchor::kCentre;
        break;
    default: // messages may hold any number
        return decode_error("grid.anchor: unknown value");
    }
    if (const auto problem = grid_problem(grid)) {
        return decode_error(*problem);
    }
    return grid;
}

void to_proto(const ViewSet& set, v1::ViewSet& message) {
    to_proto(set.grid, *message.mutable_grid());
    message.set_width_px(set.width_px);
    message.set_height_px(set.height_px);
    message.set_fovy_rad(set.fovy_rad);
}

Decoded<ViewSet> from_proto(const v1::ViewSet& message) {
    const v1::Grid& grid_message = message.grid();
    if (!grid_message.has_spacing_x_m() || !grid_message.has_spacing_y_m() || !grid_message.has_convergence_m()) {
        return decode_error("view_set.grid: spacing and convergence must be set");
    }
    const auto grid = from_proto(grid_message, LatticeGeometry{});
    if (!grid) {
        return tl::unexpected(grid.error());
    }
    const ViewSet set{*grid, message.width_px(), message.height_px(), message.fovy_rad()};
    if (!is_side(set.width_px) || !is_side(set.height_px)) {
        return decode_error("view_set: " + std::to_string(set.width_px) + "x" + std::to_string(set.height_px) +
                            " pixels, sides are 1 to 16384");
    }
    if (!(set.fovy_rad > 0.0F && set.fovy_rad < std::numbers::pi_v<float>)) {
        return decode_error("view_set.fovy_rad: must lie between 0 and pi");
    }
    return set;
}

} // namespace fieldcast::wire
