// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/render_flags.h"

#include "core/lightfield/presets.h"
#include "server/command_line/typed_text.h"
#include "server/command_line/word_flags.h"

#include <array>

namespace fieldcast::command_line {

namespace {

constexpr const char* kGroup = "Rendering";

constexpr std::array kSamplers{Word{.word = "z-sobol", .value = Sampler::kZSobol},
                               Word{.word = "sobol", .value = Sampler::kSobol}};
constexpr std::array kToneMaps{Word{.word = "srgb", .value = ToneMap::kClampSrgb},
                               Word{.word = "aces", .value = ToneMap::kAces}};

void add_path_flags(CLI::App& app, WordFlags& words, RenderText& text, RenderSettings& render) {
    const auto add = [&](const char* flag, auto& value, const char* help) {
        app.add_option(flag, value, help)->group(kGroup)->capture_default_str();
    };
    add("--spp", render.samples_per_pixel, "Samples per pixel.");
    add("--bounces", render.max_bounces, "Largest number of bounces of a path.");
    add("--light-candidates", render.light_sampling.candidates, "Candidates among which a light sample is chosen.");
    words
        .add("--each-light-kind", render.light_sampling.each_kind, kOnOff,
             "on: sky, emissive surfaces and lamps get one shadow ray each at visible surfaces, and shadows of lamps "
             "and "
             "sun are filtered apart; off: one shadow ray for all.")
        ->group(kGroup);
    words
        .add(
            "--history-light", render.history_light, kOnOff,
            "on: paths end on surfaces that were visible in the previous frame, with the light that they had there; or "
            "off.")
        ->group(kGroup);
    app.add_flag("--no-nee", text.lacks_next_event_estimation, "Trace without next event estimation.")->group(kGroup);
    app.add_flag("--accumulate", render.accumulate,
                 "While nothing moves, average frames without bias instead of denoising them.")
        ->group(kGroup);
    words
        .add("--sampler", render.sampler, kSamplers,
             "Random numbers: z-sobol (neighbouring pixels complement one another) or sobol (independent pixels).")
        ->group(kGroup);
}

/// What happens to traced light.
void add_filter_flags(CLI::App& app, WordFlags& words, RenderText& text, RenderSettings& render) {
    words.add("--denoiser", render.denoiser, "Denoiser: svgf+, svgf, bmfr or none.")->group(kGroup);
    words
        .add("--reflections", render.reflections, kOnOff,
             "on: smooth surfaces show in each view what they mirror there; off: every view gets the source's "
             "reflection.")
        ->group(kGroup);
    app.add_option("--holes", text.holes,
                   "Fill for pixels that no source shows: all, none (path traced), or a list of "
                   "previous,isolated,cascade,source,denoise.")
        ->group(kGroup)
        ->capture_default_str();
    words.add("--denoise", render.denoised_images, "Images that are denoised: source, or views (all of them).")
        ->group(kGroup);
    words
        .add("--accumulate-views", render.accumulate_views, kOnOff,
             "on: every view also averages its own light over frames, as in the paper; or off.")
        ->group(kGroup);
    app.add_option("--alpha", render.temporal_alpha, "Weight of a new frame in the history, above 0, at most 1.")
        ->group(kGroup)
        ->capture_default_str();
}

} // namespace

void add_render_flags(CLI::App& app, WordFlags& words, RenderText& text, channel::Settings& rendering) {
    const auto add = [&](const char* flag, auto& value, const std::string& help) {
        return app.add_option(flag, value, help)->group(kGroup)->capture_default_str();
    };
    add("--preset", text.preset, "Sets the defaults of the other flags: " + preset_names() + ".");
    add_path_flags(app, words, text, rendering.render);
    add_filter_flags(app, words, text, rendering.render);
    add("--exposure", text.exposure, "auto (log average of the first frame, then kept), or a factor.");
    words.add("--tone-map", rendering.render.tone_map, kToneMaps, "Tone map: srgb or aces.")->group(kGroup);
    add("--seed", rendering.seed, "Seed of all random numbers.");
    add("--traversal", rendering.traversal, "Ray traversal: auto (the faster one), bvh or rayquery.")
        ->check(CLI::IsMember({"auto", "bvh", "rayquery"}));
    add("--visibility", rendering.visibility, "Visibility method for views: rays, raster, or auto (the faster one).")
        ->check(CLI::IsMember({"auto", "rays", "raster"}));
    app.add_option("--device", rendering.device, "Part of a Vulkan device's name; default: the best device.")
        ->group(kGroup);
    app.add_flag("--validation", rendering.has_validation, "Turn the Vulkan validation layer on.")->group(kGroup);
}

void read_rendering(const RenderText& text, channel::Settings& rendering, std::vector<std::string>& problems) {
    if (!find_preset(text.preset, 1, 1)) {
        problems.push_back("--preset " + text.preset + ": one of " + preset_names());
    }
    if (const auto holes = parse_hole_filling(text.holes, rendering.largest_grid.rows, rendering.largest_grid.cols)) {
        rendering.render.holes = *holes;
    } else {
        problems.push_back("--holes " + text.holes +
                           ": write all, none, or a list of previous,isolated,cascade,source,denoise");
    }
    rendering.render.next_event_estimation = !text.lacks_next_event_estimation;
    rendering.has_auto_exposure = text.exposure == "auto";
    if (rendering.has_auto_exposure) {
        return;
    }
    if (const auto exposure = read_number<float>(text.exposure)) {
        rendering.render.exposure = *exposure;
    } else {
        problems.push_back("--exposure " + text.exposure + ": 'auto' or a number above 0");
    }
}

} // namespace fieldcast::command_line
