// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/render_settings.h"

namespace fieldcast {

/// A way to make light fields, as benchmarks compare them.
struct Preset {
    RenderSettings settings;
    bool has_guard_band = true;
    std::string sources = "middle"; ///< parse_sources()
};

/// "reprojected": one sample per pixel, neither accumulated nor denoised. "svgf", "bmfr": with those papers'
/// parameters. "paper": svgf, and every view averages its own light over frames. "paper-red": SVGF denoises
/// every view, the light field paper's red route. All without guard band, with path traced holes and one light sample, as
/// in that paper. "default": what the flags have by themselves, holes cascaded from the corners of a grid of `rows` ×
/// `cols`. "denoised-views": the same with every view denoised. Words after slashes change one thing each, as in
/// "default/sobol/no-reflections" (preset_names() lists them). Empty if there is no such preset.
std::optional<Preset> find_preset(const std::string& name, std::uint32_t rows, std::uint32_t cols);

/// The names and the changes, for messages.
std::string preset_names();

} // namespace fieldcast
