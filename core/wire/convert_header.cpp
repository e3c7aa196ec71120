// SPDX-License-Identifier: Apache-2.0
// Frame headers. convert.cpp and convert_settings.cpp read the cameras, grids and settings in them.
#include "core/wire/convert.h"

#include "core/base/printable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace fieldcast::wire {

namespace {

constexpr float kMaxSpacingM = 1e9F;
constexpr float kMaxInverseDepthUnit = 1e6F; // 1/m
constexpr int kMaxStages = 64;
constexpr std::size_t kMaxStageName = 64;

Decoded<std::vector<StageTime>> stages_from_proto(const v1::FrameHeader& message) {
    if (message.render_times_size() > kMaxStages) {
        return decode_error("header.render_times: more than " + std::to_string(kMaxStages));
    }
    std::vector<StageTime> stages;
    for (const v1::StageTime& entry : message.render_times()) {
        if (entry.stage().size() > kMaxStageName || !std::isfinite(entry.ms()) || entry.ms() < 0.0) {
            return decode_error("header.render_times: a name is too long, or a time is not a number >= 0");
        }
        stages.push_back({printable(entry.stage()), entry.ms()});
    }
    return stages;
}

/// `Message` is SourceSet, or ResidualLayer with the positions of its views.
template <class Message>
void lattice_to_proto(const std::vector<LatticePosition>& positions, const LatticeGeometry& geometry,
                      Message& message) {
    for (const LatticePosition position : positions) {
        v1::LatticePosition& entry = *message.add_positions();
        entry.set_row_halves(position.row_halves);
        entry.set_col_halves(position.col_halves);
    }
    message.set_spacing_x_m(geometry.spacing_m.x);
    message.set_spacing_y_m(geometry.spacing_m.y);
    message.set_convergence_m(std::isinf(geometry.convergence_m) ? 0.0F : geometry.convergence_m);
}

Decoded<void> sources_from_proto(const v1::SourceSet& message, FrameHeader& header) {
    constexpr int kMaxHalves = 2 * static_cast<int>(kMaxViews);
    if (message.positions().empty() || message.positions_size() > static_cast<int>(kMaxSources)) {
        return decode_error("header.sources: " + std::to_string(message.positions_size()) +
                            " positions, expected 1 to 8");
    }
    header.source_positions.clear();
    for (const v1::LatticePosition& entry : message.positions()) {
        const LatticePosition position{entry.row_halves(), entry.col_halves()};
        const bool is_near = std::abs(std::int64_t{position.row_halves}) <= kMaxHalves &&
                             std::abs(std::int64_t{position.col_halves}) <= kMaxHalves;
        if (!is_near || std::ranges::find(header.source_positions, position) != header.source_positions.end()) {
            return decode_error("header.sources.positions: a position is there twice, or beyond 144 half steps");
        }
        header.source_positions.push_back(position);
    }
    LatticeGeometry& geometry = header.source_geometry;
    geometry.spacing_m = {message.spacing_x_m(), message.spacing_y_m()};
    geometry.convergence_m =
        message.convergence_m() == 0.0F ? std::numeric_limits<float>::infinity() : message.convergence_m();
    const bool is_spaced = geometry.spacing_m.x >= 0.0F && geometry.spacing_m.x <= kMaxSpacingM &&
                           geometry.spacing_m.y >= 0.0F && geometry.spacing_m.y <= kMaxSpacingM;
    if (!is_spaced || !(geometry.convergence_m > 0.0F)) {
        return decode_error("header.sources: spacing must be finite and not negative, convergence above 0");
    }
    return {};
}

/// The tile numbers of a residual layer, ascending. Sizes of planes follow from their count, so it is checked before
/// any number is kept.
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
    lattice_to_proto(residual.positions, residual.geometry, message);
    std::uint32_t next = 0;
    for (const std::uint32_t tile : residual.tiles) {
        message.add_gaps(tile - next);
        next = tile + 1;
    }
}

/// Reads positions and geometry with the checks for those of sources.
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

/// Reads cameras, layers and the residual layer, from which the sizes of planes follow, and checks those sizes.
Decoded<void> pictures_from_proto(const v1::FrameHeader& message, FrameHeader& header) {
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
    if (with_guard_band(*source, *band).width_px > kMaxPlaneSide ||
        plane_height(header, PlaneSemantic::kDiffuse) > kMaxPlaneSide) {
        return decode_error("header: sources with guard band and layers exceed 16384 pixels");
    }
    return {};
}

} // namespace

void to_proto(const FrameHeader& header, v1::FrameHeader& message) {
    message.set_scene_time_ns(header.scene_time_ns);
    message.set_cut(header.cut);
    message.set_seed(header.seed);
    message.set_noise_frame(header.noise_frame);
    to_proto(header.source, *message.mutable_source());
    to_proto(header.guard_band, *message.mutable_guard_band());
    lattice_to_proto(header.source_positions, header.source_geometry, *message.mutable_sources());
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
    header.still_frames = message.still_frames();
    if (message.has_applied_pose() && message.applied_pose().lease() == 0) {
        return decode_error("header.applied_pose.lease: 0, must be above 0");
    }
    header.applied_pose = applied_pose_from_proto(message);
    if (const auto read = pictures_from_proto(message, header); !read) {
        return tl::unexpected(read.error());
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
