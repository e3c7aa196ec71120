// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/quality_run.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "bench/quality/picture_files.h"
#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kSettle = 30;        // frames at rest before flicker is measured
constexpr std::uint32_t kRest = kSettle + 8; // all frames at rest

} // namespace

QualityRun::QualityRun(const gpu::Device& device, const QualitySettings& settings)
    : settings_(settings), scene_(device, {.file = settings.scene.file, .size = settings.protocol.size}),
      references_(device, scene_, settings.references), truth_(scene_, references_, settings_.protocol) {
    if (settings.has_light_field && settings.renders_scored_views_only) {
        throw UserError("--light-field needs all views: leave out --scored-views");
    }
    exposure_ = choose_exposure(device, scene_, settings.exposure, settings.scene);
    shown_.id = {last_frame(), settings_.protocol.views.back()};
    add_rows(device);
}

void QualityRun::add_rows(const gpu::Device& device) {
    rows_.emplace_back("1 spp", std::make_unique<ViewMaker>(device, scene_, exposure_));
    for (const std::string& name : settings_.presets) {
        auto preset = find_preset(name, scene_.grid().rows, scene_.grid().cols);
        if (!preset) {
            throw UserError("--presets " + name + ": expected some of " + preset_names());
        }
        preset->settings.exposure = exposure_;
        if (settings_.indirect_clamp >= 0.0F) {
            preset->settings.indirect_clamp = settings_.indirect_clamp;
        }
        rows_.emplace_back(name, std::make_unique<ViewMaker>(device, scene_, *preset));
    }
}

const ViewMaker* QualityRun::find_reusing() const {
    const auto row =
        std::ranges::find_if(rows_, [](const QualityRow& candidate) { return candidate.maker().reuses(); });
    return row != rows_.end() ? &row->maker() : nullptr;
}

std::vector<PictureId> QualityRun::wanted_references() const {
    std::vector<PictureId> wanted = settings_.protocol.pictures();
    if (settings_.has_light_field) {
        for (const LatticePosition position : lattice_positions(scene_.grid())) {
            wanted.push_back({last_frame(), position});
        }
    }
    return wanted;
}

void QualityRun::run() {
    make_references(scene_, references_, wanted_references(), settings_.protocol.reference_samples);
    const std::uint32_t frame_count = last_frame() + 1 + (settings_.has_temporal ? kRest : 0);
    const std::vector<LatticePosition> positions =
        settings_.renders_scored_views_only ? settings_.protocol.views : lattice_positions(scene_.grid());
    const InterruptGuard guard;
    Progress progress("frames", static_cast<double>(frame_count * rows_.size()));
    for (std::uint32_t frame = 0; frame < frame_count; ++frame) {
        scene_.pose(std::min(frame, last_frame()));
        for (QualityRow& row : rows_) {
            row.maker().render(frame, positions);
            progress.add(1.0);
            if (guard.is_interrupted()) {
                throw Interrupted{"no results were written; references are kept"};
            }
        }
        take_frame(frame);
    }
}

/// Scores a frame that all rows have made.
void QualityRun::take_frame(std::uint32_t frame) {
    if (settings_.protocol.is_scored(frame)) {
        score_frame(frame);
    }
    if (frame == last_frame() && settings_.has_light_field) {
        score_light_field();
    }
    if (settings_.has_temporal && settings_.protocol.is_scored(frame + 1)) {
        for (QualityRow& row : rows_) {
            row.keep_frame(settings_.protocol.views);
        }
        if (const ViewMaker* maker = find_reusing()) {
            truth_.note_frame(*maker);
        }
    }
    if (frame > last_frame() + kSettle) {
        for (QualityRow& row : rows_) {
            row.score_at_rest(settings_.protocol.views);
        }
    }
}

void QualityRun::score_frame(std::uint32_t frame) {
    const auto truths = truth_.of_frame(frame, find_reusing());
    for (QualityRow& row : rows_) {
        row.add_cost();
        for (const LatticePosition position : settings_.protocol.views) {
            const PictureId id{frame, position};
            keep(row.name(), id, row.score(id, truths.at(position)));
        }
    }
    for (const LatticePosition position : settings_.protocol.views) {
        keep(kReferenceName, {frame, position}, truths.at(position).reference.mean);
    }
}

void QualityRun::score_light_field() {
    LightFieldPictures truth;
    const ViewMaker* maker = find_reusing();
    FC_ASSERT(maker != nullptr, "some row reuses");
    for (const LatticePosition position : lattice_positions(scene_.grid())) {
        truth.references.push_back(
            references_.get(last_frame(), position, settings_.protocol.reference_samples, {}).value().mean);
        truth.surfaces.push_back(maker->surfaces(position));
    }
    for (QualityRow& row : rows_) {
        row.score_light_field(scene_.grid(), truth);
    }
}

void QualityRun::keep(const std::string& name, const PictureId& id, const image::RgbF32& linear) {
    if (!settings_.out.empty()) {
        write_picture(settings_.out, picture_name(name, id), linear, exposure_);
    }
    if (id == shown_.id) {
        shown_.pictures.push_back({name, linear});
    }
}

nlohmann::ordered_json QualityRun::result() const {
    nlohmann::ordered_json json{{"scene", settings_.scene.title},
                                {"protocol", settings_.protocol.name},
                                {"size", to_string(settings_.protocol.size)},
                                {"frames", settings_.protocol.frames},
                                {"reference_samples", settings_.protocol.reference_samples},
                                {"rendered_views", settings_.renders_scored_views_only ? "scored" : "all"},
                                {"exposure", exposure_}};
    for (const QualityRow& row : rows_) {
        json["rows"][row.name()] = row.to_json();
        for (const PictureScore& picture : row.scores().pictures()) {
            const ViewIndex index = view_index(picture.id.position);
            json["pictures"].push_back({{"input", row.name()},
                                        {"frame", picture.id.frame},
                                        {"row", index.row},
                                        {"col", index.col},
                                        {"rmse", picture.rmse},
                                        {"ssim", picture.ssim},
                                        {"rmse_without_noise", picture.rmse_without_noise},
                                        {"ssim_without_noise", picture.ssim_without_noise},
                                        {"relative_mse", picture.relative_mse},
                                        {"file", picture_name(row.name(), picture.id)},
                                        {"reference", picture_name(kReferenceName, picture.id)}});
        }
    }
    return json;
}

std::uint64_t QualityRun::invalid_samples() const {
    std::uint64_t count = 0;
    for (const QualityRow& row : rows_) {
        count += row.maker().invalid_samples();
    }
    return count;
}

} // namespace fieldcast::bench
