// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/presets.h"

#include <sstream>

namespace fieldcast {

namespace {

std::optional<Preset> named_preset(const std::string& name, std::uint32_t rows, std::uint32_t cols) {
    Preset preset;
    if (name == "default" || name == "denoised-views") {
        preset.settings.holes.cascade_rows = rows;
        preset.settings.holes.cascade_cols = cols;
        preset.settings.denoised_images = name == "denoised-views" ? DenoisedImages::kViews : DenoisedImages::kSource;
        return preset;
    }
    preset.has_guard_band = false;
    preset.settings.holes = HoleFilling::path_traced();
    preset.settings.light_sampling = LightSampling::plain();
    preset.settings.sampler = Sampler::kSobol;
    preset.settings.history_light = false;
    preset.settings.reflections = false;
    if (name == "reprojected") {
        preset.settings.denoiser = Denoiser::kNone;
        preset.settings.temporal_accumulation = false;
        return preset;
    }
    if (name == "svgf" || name == "paper" || name == "paper-red") {
        preset.settings.denoiser = Denoiser::kSvgf;
        preset.settings.accumulate_views = name == "paper";
        preset.settings.denoised_images = name == "paper-red" ? DenoisedImages::kViews : DenoisedImages::kSource;
        return preset;
    }
    if (name == "bmfr") {
        preset.settings.denoiser = Denoiser::kBmfr;
        return preset;
    }
    return std::nullopt;
}

/// Changes one setting of a preset, so that its effect can be measured. False if the word is unknown.
bool change(Preset& preset, const std::string& word) {
    RenderSettings& settings = preset.settings;
    if (word == "sobol") {
        settings.sampler = Sampler::kSobol;
    } else if (word == "z-sobol") {
        settings.sampler = Sampler::kZSobol;
    } else if (word == "no-candidates") {
        settings.light_sampling = LightSampling::plain();
    } else if (word == "one-light-sample") {
        settings.light_sampling.each_kind = false;
    } else if (word == "no-history-light") {
        settings.history_light = false;
    } else if (word == "no-reflections") {
        settings.reflections = false;
    } else if (word == "no-guard-band") {
        preset.has_guard_band = false;
    } else if (word == "traced-holes") {
        settings.holes = HoleFilling::path_traced();
    } else {
        return false;
    }
    return true;
}

} // namespace

std::optional<Preset> find_preset(const std::string& name, std::uint32_t rows, std::uint32_t cols) {
    std::istringstream words(name);
    std::string word;
    std::getline(words, word, '/');
    std::optional<Preset> preset = named_preset(word, rows, cols);
    while (preset && std::getline(words, word, '/')) {
        if (!change(*preset, word)) {
            return std::nullopt;
        }
    }
    return preset;
}

std::string preset_names() {
    return "reprojected, svgf, bmfr, paper, paper-red, default, denoised-views; changed by /sobol, /z-sobol, "
           "/no-candidates, /one-light-sample, /no-history-light, /no-reflections, /no-guard-band, /traced-holes";
}

} // namespace fieldcast
