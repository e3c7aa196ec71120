// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/light_field_flags.h"

#include "core/lightfield/sources.h"
#include "server/command_line/typed_text.h"

#include <CLI/CLI.hpp>
#include <array>

namespace fieldcast::command_line {

namespace {

using Problems = std::vector<std::string>;

void read_guard_band(const LightFieldText& text, channel::Settings& rendering, Problems& problems) {
    std::array<std::uint32_t, 4> sides{};
    if (text.guard_band == "auto") {
        return;
    }
    rendering.guard_band_mode = channel::GuardBandMode::kFixed;
    if (text.guard_band != "none" && !read_list<std::uint32_t>(text.guard_band, sides)) {
        problems.push_back("--guard-band " + text.guard_band + ": auto, none, or LEFT,RIGHT,TOP,BOTTOM in pixels");
    }
    rendering.guard_band = {.left_px = sides[0], .right_px = sides[1], .top_px = sides[2], .bottom_px = sides[3]};
}

} // namespace

void add_light_field_flags(CLI::App& app, LightFieldText& text, channel::Settings& rendering) {
    const auto add = [&](const char* flag, auto& value, const char* help) {
        return app.add_option(flag, value, help)->group("Light field");
    };
    add("--size", text.size, "Size of the source image, pixels.")->capture_default_str();
    add("--fps", rendering.frames_per_second, "Largest number of frames per second, 0.1 to 240.")
        ->capture_default_str();
    add("--spacing", rendering.spacing_m,
        "Distance between neighbouring views, metres. Default: the camera's, else comfortable for the depths in view.");
    add("--convergence", text.convergence,
        "Depth of zero disparity, metres; inf: parallel cameras. Default: inf, or the subject's depth where the "
        "spacing "
        "follows from the depths in view.");
    add("--largest-grid", text.largest_grid, "ROWSxCOLS: the grid for which the guard band is wide enough.")
        ->capture_default_str();
    add("--sources", text.sources,
        "Path traced views: middle, top-left, diagonal, triangle, corners, or views of the largest grid as in "
        "\"0,0;5,5\".")
        ->capture_default_str();
    add("--guard-band", text.guard_band, "Margin of the source image: auto, none, or LEFT,RIGHT,TOP,BOTTOM in pixels.")
        ->capture_default_str();
}

void read_light_field(const LightFieldText& text, channel::Settings& rendering, Problems& problems) {
    read_guard_band(text, rendering, problems);
    if (const auto size = parse_size(text.size)) {
        rendering.width_px = size->x;
        rendering.height_px = size->y;
    } else {
        problems.push_back("--size " + text.size + ": write WIDTHxHEIGHT, as in 1280x720");
    }
    if (const auto grid = parse_grid(text.largest_grid)) {
        rendering.largest_grid = *grid;
    } else {
        problems.push_back("--largest-grid " + text.largest_grid + ": write ROWSxCOLS, as in 6x6");
    }
    if (auto positions = parse_sources(text.sources, rendering.largest_grid)) {
        rendering.source_positions = std::move(*positions);
    } else {
        problems.push_back(
            "--sources " + text.sources +
            ": middle, top-left, diagonal, triangle, corners, or views of the largest grid as in \"0,0;5,5\"");
    }
    rendering.has_convergence = !text.convergence.empty();
    if (const auto metres = read_number<float>(text.convergence)) {
        rendering.lattice.convergence_m = *metres;
    } else if (rendering.has_convergence) {
        problems.push_back("--convergence " + text.convergence + ": a number of metres, or inf");
    }
}

} // namespace fieldcast::command_line
