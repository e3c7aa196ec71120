// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/presets.h"

namespace fieldcast {

std::optional<Preset> find_preset(const std::string& name, std::uint32_t rows, std::uint32_t cols) {
    Preset preset;
    if (name == "ours") {
        preset.settings.holes.cascade_rows = rows;
        preset.settings.holes.cascade_cols = cols;
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
    if (name == "svgf") {
        preset.settings.denoiser = Denoiser::kSvgf;
        return preset;
    }
    return std::nullopt;
}

std::string preset_names() {
    return "reprojected, svgf, ours";
}

} // namespace fieldcast
