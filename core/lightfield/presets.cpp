// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/presets.h"

namespace fieldcast {

std::optional<Preset> find_preset(const std::string& name, std::uint32_t rows, std::uint32_t cols) {
    Preset preset;
    if (name == "ours" || name == "red") {
        preset.settings.holes.cascade_rows = rows;
        preset.settings.holes.cascade_cols = cols;
        preset.settings.route = name == "red" ? Route::kRed : Route::kGreen;
        return preset;
    }
    preset.has_guard_band = false;
    preset.settings.holes = HoleFilling::path_traced();
    preset.settings.light_sampling = LightSampling::plain();
    if (name == "reprojected") {
        preset.settings.denoiser = Denoiser::kNone;
        preset.settings.temporal_accumulation = false;
        return preset;
    }
    if (name == "svgf" || name == "paper" || name == "paper-red") {
        preset.settings.denoiser = Denoiser::kSvgf;
        preset.settings.accumulate_views = name == "paper";
        preset.settings.route = name == "paper-red" ? Route::kRed : Route::kGreen;
        return preset;
    }
    return std::nullopt;
}

std::string preset_names() {
    return "reprojected, svgf, paper, paper-red, ours, red";
}

} // namespace fieldcast
