// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/grids_run.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kWarmUp = 2; // frames whose times do not count

std::string name_of(const ViewGrid& grid) {
    return std::to_string(grid.rows) + "x" + std::to_string(grid.cols);
}

} // namespace

GridsRun::GridsRun(const gpu::Device& device, const GridsSettings& settings)
    : settings_(settings), scene_(device, {.file = settings.scene.file, .size = settings.protocol.size}),
      references_(device, scene_, settings.references),
      exposure_(choose_exposure(device, scene_, settings.exposure, settings.scene)) {
    for (ViewGrid grid : settings.grids) {
        auto preset = find_preset(settings.preset, grid.rows, grid.cols);
        if (!preset) {
            throw UserError("--preset " + settings.preset + ": expected one of " + preset_names());
        }
        preset->settings.exposure = exposure_;
        grid.geometry = scene_.grid().geometry;
        scene_.choose_grid(grid.rows, grid.cols);
        entries_.push_back({grid, {name_of(grid), std::make_unique<ViewMaker>(device, scene_, *preset)}});
    }
}

std::vector<PictureId> GridsRun::wanted_references() const {
    std::vector<PictureId> wanted;
    for (const std::uint32_t frame : settings_.protocol.frames) {
        for (const Entry& entry : entries_) {
            for (const LatticePosition position : lattice_positions(entry.grid)) {
                const PictureId id{frame, position};
                if (std::ranges::find(wanted, id) == wanted.end()) { // grids share views
                    wanted.push_back(id);
                }
            }
        }
    }
    return wanted;
}

void GridsRun::score(Entry& entry, std::uint32_t frame) {
    for (const LatticePosition position : lattice_positions(entry.grid)) {
        const ViewTruth truth{.reference =
                                  references_.get(frame, position, settings_.protocol.reference_samples, {}).value()};
        entry.row.score({frame, position}, truth);
    }
}

void GridsRun::run() {
    make_references(scene_, references_, wanted_references(), settings_.protocol.reference_samples);
    const std::uint32_t frame_count = settings_.protocol.frames.back() + 1;
    const InterruptGuard guard;
    double views = 0.0;
    for (const Entry& entry : entries_) {
        views += entry.grid.view_count();
    }
    Progress progress("frames", frame_count * views);
    for (std::uint32_t frame = 0; frame < frame_count; ++frame) {
        scene_.pose(frame);
        for (Entry& entry : entries_) {
            entry.row.maker().render(frame, lattice_positions(entry.grid));
            if (frame >= std::min(kWarmUp, frame_count - 1)) {
                entry.row.add_cost();
            }
            if (settings_.protocol.is_scored(frame)) {
                score(entry, frame);
            }
            progress.add(entry.grid.view_count());
            if (guard.is_interrupted()) {
                throw Interrupted{"no results were written; references are kept"};
            }
        }
    }
}

nlohmann::ordered_json GridsRun::result() const {
    nlohmann::ordered_json json{{"scene", settings_.scene.title},
                                {"protocol", settings_.protocol.name},
                                {"size", to_string(settings_.protocol.size)},
                                {"reference_samples", settings_.protocol.reference_samples},
                                {"frames", settings_.protocol.frames},
                                {"preset", settings_.preset},
                                {"exposure", exposure_}};
    for (const Entry& entry : entries_) {
        nlohmann::ordered_json row{{"grid", entry.row.name()}};
        row.update(entry.row.to_json());
        std::vector<double> ssim;
        const auto positions = lattice_positions(entry.grid);
        for (const PictureScore& picture : entry.row.scores().pictures()) {
            const auto index =
                static_cast<std::size_t>(std::ranges::find(positions, picture.id.position) - positions.begin());
            ssim.push_back(picture.ssim);
            row["views"].push_back({{"frame", picture.id.frame},
                                    {"row", index / entry.grid.cols},
                                    {"col", index % entry.grid.cols},
                                    {"rmse", picture.rmse},
                                    {"ssim", picture.ssim}});
        }
        row["ssim_min"] = spread_of(ssim).min;
        json["grids"].push_back(row);
    }
    for (const auto& [lost, ssim] :
         {std::pair("ssim_lost", "ssim"), {"ssim_lost_without_noise", "ssim_without_noise"}}) {
        json[lost] = json["grids"].front()[ssim].get<double>() - json["grids"].back()[ssim].get<double>();
    }
    return json;
}

std::uint64_t GridsRun::invalid_samples() const {
    std::uint64_t count = 0;
    for (const Entry& entry : entries_) {
        count += entry.row.maker().invalid_samples();
    }
    return count;
}

} // namespace fieldcast::bench
