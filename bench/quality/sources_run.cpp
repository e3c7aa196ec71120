// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/sources_run.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "bench/quality/heat_map.h"
#include "core/base/error.h"
#include "core/lightfield/sources.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kWarmUp = 2; // frames whose times do not count

} // namespace

SourcesRun::SourcesRun(const gpu::Device& device, const SourcesSettings& settings)
    : settings_(settings), scene_(device, {.file = settings.scene.file, .size = settings.protocol.size}),
      references_(device, scene_, settings.references),
      exposure_(choose_exposure(device, scene_, settings.exposure, settings.scene)) {
    if (settings_.scores_all_views) {
        settings_.protocol.frames = {settings_.protocol.frames.back()};
    }
    const ViewGrid& grid = scene_.grid();
    for (const std::string& name : settings_.configurations) {
        auto preset = find_preset(settings_.preset, grid.rows, grid.cols);
        if (!preset) {
            throw UserError("--preset " + settings_.preset + ": expected one of " + preset_names());
        }
        preset->settings.exposure = exposure_;
        preset->sources = name;
        QualityRow row(name, std::make_unique<ViewMaker>(device, scene_, *preset)); // which checks the name
        entries_.push_back({name, parse_sources(name, grid).value(), std::move(row)});
    }
}

std::vector<LatticePosition> SourcesRun::scored_views() const {
    return settings_.scores_all_views ? lattice_positions(scene_.grid()) : settings_.protocol.views;
}

void SourcesRun::run() {
    std::vector<PictureId> wanted;
    for (const std::uint32_t frame : settings_.protocol.frames) {
        for (const LatticePosition position : scored_views()) {
            wanted.push_back({frame, position});
        }
    }
    make_references(scene_, references_, wanted, settings_.protocol.reference_samples);
    const std::uint32_t frame_count = settings_.protocol.frames.back() + 1;
    const InterruptGuard guard;
    Progress progress("frames", static_cast<double>(frame_count) * static_cast<double>(entries_.size()));
    for (std::uint32_t frame = 0; frame < frame_count; ++frame) {
        scene_.pose(frame);
        for (Entry& entry : entries_) {
            entry.row.maker().render(frame, lattice_positions(scene_.grid()));
            if (frame >= std::min(kWarmUp, frame_count - 1)) {
                entry.row.add_cost();
            }
            for (const LatticePosition position : scored_views()) {
                if (settings_.protocol.is_scored(frame)) {
                    entry.row.score(
                        {frame, position},
                        {.reference =
                             references_.get(frame, position, settings_.protocol.reference_samples, {}).value()});
                }
            }
            progress.add(1.0);
            if (guard.is_interrupted()) {
                throw Interrupted{"no results were written; references are kept"};
            }
        }
    }
}

nlohmann::ordered_json SourcesRun::views_of(const Entry& entry) const {
    nlohmann::ordered_json views = nlohmann::ordered_json::array();
    const double pixels = static_cast<double>(scene_.size().width_px) * scene_.size().height_px;
    for (const LatticePosition position : lattice_positions(scene_.grid())) {
        const ViewIndex index = view_index(position);
        nlohmann::ordered_json view{{"row", index.row},
                                    {"col", index.col},
                                    {"discard_share", entry.row.maker().discards(position) / pixels}};
        for (const PictureScore& picture : entry.row.scores().pictures()) {
            if (settings_.scores_all_views && picture.id.position == position) {
                view["rmse"] = picture.rmse;
                view["ssim"] = picture.ssim;
            }
        }
        views.push_back(view);
    }
    return views;
}

nlohmann::ordered_json SourcesRun::result() const {
    nlohmann::ordered_json json{{"scene", settings_.scene.title},
                                {"protocol", settings_.protocol.name},
                                {"size", to_string(settings_.protocol.size)},
                                {"reference_samples", settings_.protocol.reference_samples},
                                {"frames", settings_.protocol.frames},
                                {"preset", settings_.preset},
                                {"exposure", exposure_}};
    for (const Entry& entry : entries_) {
        nlohmann::ordered_json row{{"sources", entry.name}, {"source_count", entry.positions.size()}};
        row.update(entry.row.to_json());
        row["views"] = views_of(entry);
        json["sources"].push_back(row);
    }
    return json;
}

void SourcesRun::write_heat_maps(const nlohmann::ordered_json& result) const {
    for (const char* measure : {"discard_share", "rmse", "ssim"}) {
        if (!result["sources"].front()["views"].front().contains(measure)) {
            continue;
        }
        std::vector<std::vector<double>> maps;
        double brightest = 0.0;
        for (const auto& row : result["sources"]) {
            std::vector<double>& values = maps.emplace_back();
            for (const auto& view : row["views"]) {
                values.push_back(view[measure]);
                brightest = std::max(brightest, values.back());
            }
        }
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            image::write_png(settings_.out / (std::string(measure) + "_" + std::to_string(i) + ".png"),
                             heat_map(scene_.grid(), maps[i], brightest, entries_[i].positions));
        }
    }
}

std::uint64_t SourcesRun::invalid_samples() const {
    std::uint64_t count = 0;
    for (const Entry& entry : entries_) {
        count += entry.row.maker().invalid_samples();
    }
    return count;
}

} // namespace fieldcast::bench
