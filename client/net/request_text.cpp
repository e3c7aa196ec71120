// SPDX-License-Identifier: Apache-2.0
#include "client/net/request_text.h"

#include <numbers>

namespace fieldcast::client::net {
namespace {

using Text = const std::string&;

const WordList<bool>& switches() {
    static const WordList<bool> words{{"on", true}, {"off", false}};
    return words;
}

SettingProblem read_grid(Text text, std::uint32_t& rows, std::uint32_t& cols) {
    const auto grid = parse_grid(text);
    if (!grid) {
        return "write ROWSxCOLS, as in 3x3";
    }
    rows = grid->rows;
    cols = grid->cols;
    return grid_problem(*grid).value_or("");
}

SettingProblem read_size(Text text, Request& request) {
    const auto size = parse_size(text);
    if (!size || size->x == 0 || size->y == 0 || size->x > kMaxPlaneSide || size->y > kMaxPlaneSide) {
        return "write WIDTHxHEIGHT, as in 640x360";
    }
    request.width_px = size->x;
    request.height_px = size->y;
    return {};
}

SettingProblem read_optional(Text text, double high, std::optional<float>& result) {
    float number = 0.0F;
    SettingProblem problem = read_float(text, 0.0, high, number);
    result = number;
    return problem;
}

SettingProblem read_codecs(Text text, std::vector<Codec>& codecs) {
    codecs.clear();
    for (const std::string& word : split(text, '+')) {
        const auto codec = from_word<Codec>(word);
        if (!codec) {
            return "write " + alternatives<Codec>() + "; several with +, the preferred one first";
        }
        codecs.push_back(*codec);
    }
    return {};
}

SettingProblem read_quality(Text text, double low, std::uint8_t& quality) {
    double number = 0.0;
    SettingProblem problem = read_number(text, low, kMaxQuality, number);
    quality = static_cast<std::uint8_t>(number);
    return problem;
}

} // namespace

const Setters<Request>& request_setters() {
    static const WordList<Anchor> anchors{{"lattice", Anchor::kLattice}, {"centre", Anchor::kCentre}};
    static const WordList<bool> normal_bits{{"16", false}, {"8", true}};
    static const Setters<Request> setters{
        {"anchor", [](Text text, Request& request) { return read_word(text, anchors, request.anchor); }},
        {"channel",
         [](Text text, Request& request) {
             request.channel = text;
             return SettingProblem();
         }},
        {"codec", [](Text text, Request& request) { return read_codecs(text, request.codecs); }},
        {"convergence", [](Text text, Request& request) { return read_optional(text, 1e6, request.convergence_m); }},
        {"fov",
         [](Text text, Request& request) {
             SettingProblem problem = read_float(text, 0.01, 179.0, request.fovy_rad);
             request.fovy_rad *= std::numbers::pi_v<float> / 180.0F;
             return problem;
         }},
        {"grid", [](Text text, Request& request) { return read_grid(text, request.rows, request.cols); }},
        {"max-fps", [](Text text, Request& request) { return read_rate(text, request.max_frames_per_second); }},
        {"mode", [](Text text, Request& request) { return read_word(text, request.mode); }},
        {"normal-bits",
         [](Text text, Request& request) { return read_word(text, normal_bits, request.has_coarse_normals); }},
        {"planes", [](Text text, Request& request) { return read_word(text, request.planes); }},
        {"quality", [](Text text, Request& request) { return read_quality(text, 1.0, request.quality); }},
        {"residual", [](Text text, Request& request) { return read_word(text, switches(), request.has_residual); }},
        {"size", [](Text text, Request& request) { return read_size(text, request); }},
        {"spacing", [](Text text, Request& request) { return read_optional(text, 1000.0, request.spacing_m); }},
    };
    return setters;
}

const Setters<AdaptationBounds>& adaptation_setters() {
    static const Setters<AdaptationBounds> setters{
        {"delay",
         [](Text text, AdaptationBounds& bounds) { return read_count(text, 1, 10'000, bounds.max_queue_delay_ms); }},
        {"fps", [](Text text, AdaptationBounds& bounds) { return read_rate(text, bounds.min_frames_per_second); }},
        {"grid",
         [](Text text, AdaptationBounds& bounds) {
             if (text == "0x0") {
                 bounds.min_rows = bounds.min_cols = 0;
                 return SettingProblem();
             }
             return read_grid(text, bounds.min_rows, bounds.min_cols);
         }},
        {"height",
         [](Text text, AdaptationBounds& bounds) {
             return read_count(text, 0, kMaxPlaneSide, bounds.min_view_height_px);
         }},
        {"jpeg", [](Text text, AdaptationBounds& bounds) { return read_word(text, switches(), bounds.allows_jpeg); }},
        {"quality", [](Text text, AdaptationBounds& bounds) { return read_quality(text, 0.0, bounds.min_quality); }},
        {"scene", [](Text text, AdaptationBounds& bounds) { return read_word(text, switches(), bounds.allows_scene); }},
    };
    return setters;
}

} // namespace fieldcast::client::net
