// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/warp_run.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "core/image/metrics.h"
#include "core/lightfield/normal_precision.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;

/// The corners of a grid, and views between them and the source.
std::vector<LatticePosition> chosen_positions(const ViewGrid& grid) {
    std::vector<LatticePosition> positions = render::residual_positions(grid);
    const std::uint32_t bottom = grid.rows - 1;
    const std::uint32_t right = grid.cols - 1;
    for (const auto& [row, col] : {std::pair(bottom / 2, right), std::pair(bottom, right / 2),
                                   std::pair(bottom / 4, right / 4), std::pair(3 * bottom / 4, 3 * right / 4)}) {
        const LatticePosition position = lattice_position(grid, row, col);
        if (std::ranges::find(positions, position) == positions.end()) {
            positions.push_back(position);
        }
    }
    return positions;
}

RenderSettings render_settings(const LightFieldScene& scene, const WarpSettings& settings) {
    RenderSettings render;
    render.exposure = settings.exposure;
    render.holes = parse_holes("all", scene.grid());
    return render;
}

/// Bytes of the tile list in a frame's header: one varint per tile.
double tile_list_bytes(const std::vector<std::uint32_t>& tiles) {
    double bytes = 0.0;
    std::uint32_t next = 0;
    for (const std::uint32_t tile : tiles) {
        for (std::uint32_t gap = tile - next; gap >= 0x80; gap >>= 7) {
            bytes += 1.0;
        }
        bytes += 1.0;
        next = tile + 1;
    }
    return bytes;
}

double percent(double count, const Views& views) {
    double pixels = 0.0;
    for (const View& view : views.views) {
        pixels += static_cast<double>(view.image.width_px) * view.image.height_px;
    }
    return 100.0 * count / pixels;
}

constexpr const char* kFinished = "finished"; // name of the server's views

std::string numbered(const std::string& stem, std::size_t i) {
    return stem + "_" + std::to_string(i);
}

const Coding kLossless{"zstd", {Codec::kZstdFiltered, 0}};

} // namespace

WarpRun::WarpRun(const gpu::Device& device, LightFieldScene& scene, const WarpSettings& settings)
    : scene_(scene), settings_(settings), positions_(chosen_positions(scene.grid())),
      run_(device, scene, render_settings(scene, settings), true), grid_renderer_(device, scene.gpu_scene()),
      planes_(device, scene.gpu_scene(), grid_renderer_), warp_(device) {}

void WarpRun::run() {
    const InterruptGuard interrupt;
    Progress progress("frames", settings_.frames);
    for (std::uint32_t frame = 0; frame < settings_.frames; ++frame) {
        scene_.pose(frame);
        run_.render(frame, {LatticePosition{}}); // renders the source
        progress.add(1.0);
        if (interrupt.is_interrupted()) {
            throw Interrupted{"no results were written"};
        }
    }
    measure();
}

void WarpRun::measure() {
    SourceFrame frame = run_.source().download(render::kSourceSemantics);
    planes_.render(run_.source(), scene_.grid(), true, frame);
    const Views finished = grid_renderer_.render(run_.source(), scene_.request(positions_));
    const Camera camera = run_.source().camera();
    result_ = {{"source_size", to_string(Size{camera.width_px, camera.height_px})},
               {"guard_band_share", run_.guard_band().extra_share},
               {"view_count", positions_.size()},
               {"inverse_depth_unit", frame.header.inverse_depth_unit},
               {"tiles", frame.header.residual.tiles.size()}};
    for (const auto& [name, semantic] :
         {std::pair("colour", PlaneSemantic::kColour), std::pair("inverse_depth", PlaneSemantic::kInverseDepth),
          std::pair("residual_colour", PlaneSemantic::kResidualColour),
          std::pair("residual_inverse_depth", PlaneSemantic::kResidualInverseDepth),
          std::pair("depth", PlaneSemantic::kDepth), std::pair("normal", PlaneSemantic::kNormal),
          std::pair("id", PlaneSemantic::kId)}) {
        result_["plane_bytes"][name] = code_plane(*frame.find(semantic), kLossless, {}, 1.0F).bytes;
    }
    const Plane coarse = coarse_normals(*frame.find(PlaneSemantic::kNormal));
    result_["plane_bytes"]["normal_oct2x8"] = code_plane(coarse, kLossless, {}, 1.0F).bytes;
    result_["plane_bytes"]["tile_list"] = tile_list_bytes(frame.header.residual.tiles);
    std::vector<Coding> codings{kLossless};
    for (const std::uint32_t quality : settings_.qualities) {
        codings.push_back(
            {"jpeg " + std::to_string(quality), {Codec::kJpeg, static_cast<std::uint8_t>(quality)}});
    }
    write_pictures(kFinished, finished);
    measure_scene(frame);
    SourceFrame without_residual = frame;
    without_residual.header.residual = {};
    for (const Coding& coding : codings) {
        measure_views(finished, coding);
        measure_warp(frame, finished, coding);
        measure_warp(without_residual, finished, coding);
    }
}

void WarpRun::measure_views(const Views& finished, const Coding& coding) {
    Views decoded = finished;
    double bytes = 0.0;
    for (View& view : decoded.views) {
        CodedPlane coded = code_plane(view.image, coding, {}, 1.0F);
        bytes += coded.bytes;
        view.image = std::move(coded.decoded);
    }
    const double of_grid = scene_.grid().view_count() / static_cast<double>(finished.views.size());
    Json row{{"mode", "views"}, {"coding", coding.name}, {"bytes", bytes * of_grid}};
    add_row(std::move(row), decoded, finished);
}

// Clients with the scene make bitwise equal views. `codecs` measures the effect of lossy light.
void WarpRun::measure_scene(const SourceFrame& frame) {
    double bytes = 0.0;
    for (const PlaneSemantic semantic : {PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular}) {
        bytes += code_plane(*frame.find(semantic), kLossless, {}, frame.header.settings.exposure).bytes;
    }
    result_["rows"].push_back(
        {{"mode", "scene"}, {"coding", kLossless.name}, {"bytes", bytes}, {"ssim", 1.0}, {"rmse", 0.0}});
}

void WarpRun::measure_warp(const SourceFrame& frame, const Views& finished, const Coding& coding) {
    const bool has_residual = !frame.header.residual.positions.empty();
    SourceFrame decoded{frame.header, {}};
    double bytes = tile_list_bytes(frame.header.residual.tiles);
    for (const Plane& plane : frame.planes) {
        const bool is_of_source =
            plane.semantic == PlaneSemantic::kColour || plane.semantic == PlaneSemantic::kInverseDepth;
        const bool is_sent = is_of_source || (has_residual && is_residual(plane.semantic));
        if (is_sent) {
            const bool fits = carries(coding.encoding.codec, plane.format);
            CodedPlane coded = code_plane(plane, fits ? coding : kLossless, {}, 1.0F);
            bytes += coded.bytes;
            decoded.planes.push_back(std::move(coded.decoded));
        }
    }
    if (const auto taken = warp_.upload(decoded); !taken) {
        throw std::runtime_error("warp: " + taken.error().message);
    }
    const Views made = warp_.render(scene_.request(positions_));
    double ms = 0.0;
    for (const StageTime& time : made.header.render_times) {
        ms += time.stage.starts_with("warp_") ? time.ms : 0.0;
    }
    double residual = 0.0;
    double extended = 0.0;
    for (const render::WarpCounts& counts : warp_.counts()) {
        residual += counts.residual;
        extended += counts.extended();
    }
    add_row({{"mode", has_residual ? "warp" : "warp, no residual"},
             {"coding", coding.name},
             {"bytes", bytes},
             {"residual_percent", percent(residual, made)},
             {"extended_percent", percent(extended, made)},
             {"ms_per_view", ms / static_cast<double>(made.views.size())}},
            made, finished);
}

void WarpRun::add_row(Json row, const Views& made, const Views& finished) {
    const std::string input = row["mode"].get<std::string>() + " " + row["coding"].get<std::string>();
    std::string stem = input;
    std::erase(stem, ',');
    std::ranges::replace(stem, ' ', '_');
    write_pictures(stem, made);
    double ssim = 0.0;
    double rmse = 0.0;
    double worst = 1.0;
    for (std::size_t i = 0; i < made.views.size(); ++i) {
        const image::RgbF32 ours = image::display_image(made.views[i].image);
        const image::RgbF32 theirs = image::display_image(finished.views[i].image);
        const double ssim_of_view = image::ssim(ours, theirs);
        const double rmse_of_view = image::rmse(ours, theirs);
        ssim += ssim_of_view;
        worst = std::min(worst, ssim_of_view);
        rmse += rmse_of_view;
        if (!settings_.out.empty()) {
            result_["pictures"].push_back({{"file", numbered(stem, i)},
                                           {"reference", numbered(kFinished, i)},
                                           {"input", input},
                                           {"rmse", rmse_of_view},
                                           {"ssim", ssim_of_view}});
        }
    }
    const auto count = static_cast<double>(made.views.size());
    row["ssim"] = ssim / count;
    row["worst_ssim"] = worst;
    row["rmse"] = rmse / count;
    result_["rows"].push_back(std::move(row));
}

void WarpRun::write_pictures(const std::string& stem, const Views& views) const {
    if (settings_.out.empty()) {
        return;
    }
    std::filesystem::create_directories(settings_.out);
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        image::write_png(settings_.out / (numbered(stem, i) + ".png"), views.views[i].image);
    }
}

} // namespace fieldcast::bench
