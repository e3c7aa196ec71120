// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/render_settings.h"

namespace fieldcast {

/// Settings for making light fields, which benchmarks compare.
struct Preset {
    RenderSettings settings;
    bool has_guard_band = true;
    std::string sources = "middle"; ///< parse_sources()
};

/// "reprojected": one sample per pixel, neither accumulated nor denoised. "svgf", "bmfr": the parameters of those
/// papers. "paper": svgf, and every view averages its own light over frames. "paper-red": SVGF denoises every view, the
/// light field paper's red route. All of these have no guard band, path traced holes and one light sample, as in that
/// paper. "default": the defaults of the flags, with holes cascaded from the corners of a grid of `rows` × `cols`.
/// "denoised-views": the same with every view denoised. Each word after a slash changes one setting, as in
/// "default/sobol/no-reflections" (preset_names() lists them). Empty if there is no such preset.
std::optional<Preset> find_preset(const std::string& name, std::uint32_t rows, std::uint32_t cols);

/// Names of the presets and of the changes, for messages.
std::string preset_names();

} // namespace fieldcast
