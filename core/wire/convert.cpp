// SPDX-License-Identifier: Apache-2.0
// Cameras, grids and frame headers; convert_settings.cpp has the rest.
#include "core/wire/convert.h"

#include <algorithm>
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
constexpr int kMaxStages = 64;
constexpr std::size_t kMaxStageName = 64;

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

Decoded<std::vector<StageTime>> stages_from_proto(const v1::FrameHeader& message) {
    if (message.render_times_size() > kMaxStages) {
        return decode_error("header.render_times: more than " + std::to_string(kMaxStages));
    }
    std::vector<StageTime> stages;
    for (const v1::StageTime& entry : message.render_times()) {
        if (entry.stage().size() > kMaxStageName || !std::isfinite(entry.ms()) || entry.ms() < 0.0) {
            return decode_error("header.render_times: name too long or time not a number >= 0");
        }
        stages.push_back({entry.stage(), entry.ms()});
    }
    return stages;
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
        return decode_error("camera.focal_px: must be above 0, at most 1e6");
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
    default: // any number may stand in a message
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
        return decode_error("view_set.grid: spacing and convergence must be set here");
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

namespace {

void sources_to_proto(const FrameHeader& header, v1::SourceSet& message) {
    for (const LatticePosition position : header.source_positions) {
        v1::LatticePosition& entry = *message.add_positions();
        entry.set_row_halves(position.row_halves);
        entry.set_col_halves(position.col_halves);
    }
    const LatticeGeometry& geometry = header.source_geometry;
    message.set_spacing_x_m(geometry.spacing_m.x);
    message.set_spacing_y_m(geometry.spacing_m.y);
    message.set_convergence_m(std::isinf(geometry.convergence_m) ? 0.0F : geometry.convergence_m);
}

Decoded<void> sources_from_proto(const v1::SourceSet& message, FrameHeader& header) {
    constexpr int kMaxHalves = 2 * static_cast<int>(kMaxViews);
    if (message.positions().empty() || message.positions_size() > static_cast<int>(kMaxSources)) {
        return decode_error("header.sources: " + std::to_string(message.positions_size()) + " positions, expected 1 to 8");
    }
    header.source_positions.clear();
    for (const v1::LatticePosition& entry : message.positions()) {
        const LatticePosition position{entry.row_halves(), entry.col_halves()};
        const bool is_near = std::abs(std::int64_t{position.row_halves}) <= kMaxHalves &&
                             std::abs(std::int64_t{position.col_halves}) <= kMaxHalves;
        if (!is_near || std::ranges::find(header.source_positions, position) != header.source_positions.end()) {
            return decode_error("header.sources.positions: twice the same, or beyond 144 half steps");
        }
        header.source_positions.push_back(position);
    }
    LatticeGeometry& geometry = header.source_geometry;
    geometry.spacing_m = {message.spacing_x_m(), message.spacing_y_m()};
    geometry.convergence_m =
        message.convergence_m() == 0.0F ? std::numeric_limits<float>::infinity() : message.convergence_m();
    const bool is_spaced = geometry.spacing_m.x >= 0.0F && geometry.spacing_m.x <= kMaxPositionM &&
                           geometry.spacing_m.y >= 0.0F && geometry.spacing_m.y <= kMaxPositionM;
    if (!is_spaced || !(geometry.convergence_m > 0.0F)) {
        return decode_error("header.sources: spacing must be finite and not negative, convergence above 0");
    }
    return {};
}

constexpr float kMaxInverseDepthUnit = 1e6F; // 1/m

/// Sizes of planes follow from the tiles, so their number is bounded before any is kept.
Decoded<std::vector<std::uint32_t>> tiles_from_proto(const v1::ResidualLayer& message, std::uint64_t tile_count) {
    if (static_cast<std::uint64_t>(message.gaps_size()) > std::min<std::uint64_t>(max_residual_tiles(), tile_count)) {
        return decode_error("header.residual.gaps: " + std::to_string(message.gaps_size()) + " tiles, at most " +
                            std::to_string(std::min<std::uint64_t>(max_residual_tiles(), tile_count)));
    }
    std::vector<std::uint32_t> tiles;
    tiles.reserve(static_cast<std::size_t>(message.gaps_size()));
    std::uint64_t next = 0;
    for (const std::uint32_t gap : message.gaps()) {
        next += gap;
        if (next >= tile_count) {
            return decode_error("header.residual.gaps: tile " + std::to_string(next) + " of " +
                                std::to_string(tile_count));
        }
        tiles.push_back(static_cast<std::uint32_t>(next));
        ++next;
    }
    return tiles;
}

void residual_to_proto(const ResidualLayer& residual, v1::ResidualLayer& message) {
    for (const LatticePosition position : residual.positions) {
        v1::LatticePosition& entry = *message.add_positions();
        entry.set_row_halves(position.row_halves);
        entry.set_col_halves(position.col_halves);
    }
    const LatticeGeometry& geometry = residual.geometry;
    message.set_spacing_x_m(geometry.spacing_m.x);
    message.set_spacing_y_m(geometry.spacing_m.y);
    message.set_convergence_m(std::isinf(geometry.convergence_m) ? 0.0F : geometry.convergence_m);
    std::uint32_t next = 0;
    for (const std::uint32_t tile : residual.tiles) {
        message.add_gaps(tile - next);
        next = tile + 1;
    }
}

/// Positions and geometry are read as those of sources are.
Decoded<ResidualLayer> residual_from_proto(const v1::ResidualLayer& message, const Camera& source) {
    if (message.positions_size() > static_cast<int>(kMaxResidualViews)) {
        return decode_error("header.residual: " + std::to_string(message.positions_size()) + " views, at most 4");
    }
    v1::SourceSet views;
    *views.mutable_positions() = message.positions();
    views.set_spacing_x_m(message.spacing_x_m());
    views.set_spacing_y_m(message.spacing_y_m());
    views.set_convergence_m(message.convergence_m());
    FrameHeader read;
    if (const auto checked = sources_from_proto(views, read); !checked) {
        return decode_error("header.residual, read as " + checked.error().message);
    }
    const glm::uvec2 tiles_of_view = residual_tiles(source.width_px, source.height_px);
    const std::uint64_t tile_count = std::uint64_t{tiles_of_view.x} * tiles_of_view.y * read.source_positions.size();
    auto tiles = tiles_from_proto(message, tile_count);
    if (!tiles) {
        return tl::unexpected(tiles.error());
    }
    return ResidualLayer{std::move(read.source_positions), read.source_geometry, std::move(*tiles)};
}

void applied_pose_to_proto(const FrameHeader& header, v1::FrameHeader& message) {
    if (header.applied_pose) {
        v1::AppliedPose& applied = *message.mutable_applied_pose();
        applied.set_lease(header.applied_pose->lease);
        applied.set_sequence(header.applied_pose->sequence);
        applied.set_client_time_ns(header.applied_pose->client_time_ns);
    }
}

std::optional<AppliedPose> applied_pose_from_proto(const v1::FrameHeader& message) {
    const v1::AppliedPose& applied = message.applied_pose();
    return message.has_applied_pose()
               ? std::optional(AppliedPose{applied.lease(), applied.sequence(), applied.client_time_ns()})
               : std::nullopt;
}

} // namespace

void to_proto(const FrameHeader& header, v1::FrameHeader& message) {
    message.set_scene_time_ns(header.scene_time_ns);
    message.set_cut(header.cut);
    message.set_seed(header.seed);
    message.set_noise_frame(header.noise_frame);
    to_proto(header.source, *message.mutable_source());
    to_proto(header.guard_band, *message.mutable_guard_band());
    sources_to_proto(header, *message.mutable_sources());
    to_proto(header.settings, *message.mutable_settings());
    message.set_layer_count(header.layer_count);
    message.set_still_frames(header.still_frames);
    message.set_inverse_depth_unit(header.inverse_depth_unit);
    if (!header.residual.positions.empty()) {
        residual_to_proto(header.residual, *message.mutable_residual());
    }
    applied_pose_to_proto(header, message);
    message.clear_render_times();
    for (const StageTime& stage : header.render_times) {
        v1::StageTime& entry = *message.add_render_times();
        entry.set_stage(stage.stage);
        entry.set_ms(stage.ms);
    }
}

Decoded<FrameHeader> from_proto(const v1::FrameHeader& message, std::uint64_t frame_id) {
    FrameHeader header;
    header.frame_id = frame_id;
    header.scene_time_ns = message.scene_time_ns();
    header.cut = message.cut();
    header.seed = message.seed();
    header.noise_frame = message.noise_frame();
    const auto source = from_proto(message.source());
    if (!source) {
        return tl::unexpected(source.error());
    }
    header.source = *source;
    const auto band = from_proto(message.guard_band());
    if (!band) {
        return tl::unexpected(band.error());
    }
    header.guard_band = *band;
    if (message.layer_count() != 0 && message.layer_count() != kMaxLayers) {
        return decode_error("header.layer_count: " + std::to_string(message.layer_count()) + ", expected 0 or 2");
    }
    header.layer_count = message.layer_count();
    header.still_frames = message.still_frames();
    if (message.has_applied_pose() && message.applied_pose().lease() == 0) {
        return decode_error("header.applied_pose.lease: 0, expected more");
    }
    header.applied_pose = applied_pose_from_proto(message);
    if (message.has_sources()) {
        if (const auto read = sources_from_proto(message.sources(), header); !read) {
            return tl::unexpected(read.error());
        }
    }
    header.inverse_depth_unit = message.inverse_depth_unit();
    if (!(header.inverse_depth_unit >= 0.0F && header.inverse_depth_unit <= kMaxInverseDepthUnit)) {
        return decode_error("header.inverse_depth_unit: must lie between 0 and 1e6");
    }
    if (message.has_residual()) {
        auto residual = residual_from_proto(message.residual(), *source);
        if (!residual) {
            return tl::unexpected(residual.error());
        }
        header.residual = std::move(*residual);
    }
    const Camera widened = with_guard_band(*source, *band);
    if (!is_side(widened.width_px) || !is_side(plane_height(header, PlaneSemantic::kDiffuse))) {
        return decode_error("header: sources with guard band and layers exceed 16384 pixels");
    }
    const auto settings = from_proto(message.settings());
    if (!settings) {
        return tl::unexpected(settings.error());
    }
    header.settings = *settings;
    auto stages = stages_from_proto(message);
    if (!stages) {
        return tl::unexpected(stages.error());
    }
    header.render_times = std::move(*stages);
    return header;
}

} // namespace fieldcast::wire
