// SPDX-License-Identifier: Apache-2.0
#include "client/load/scenario.h"

#include "core/lightfield/frame_rate.h"
#include "core/lightfield/view_grid.h"

#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace fieldcast::client::load {
namespace {

constexpr double kMaxSeconds = 1e7;
constexpr double kMaxFps = 1000.0;

using Problem = std::string; ///< empty: none

Problem read_number(const std::string& text, double low, double high, double& result) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || !(number >= low && number <= high)) {
        char range[64];
        std::snprintf(range, sizeof range, "a number from %g to %g", low, high);
        return std::string("write ") + range;
    }
    result = number;
    return {};
}

Problem read_count(const std::string& text, std::uint32_t low, std::uint32_t high, std::uint32_t& result) {
    double number = 0.0;
    Problem problem = read_number(text, low, high, number);
    if (problem.empty() && number != std::floor(number)) {
        problem = "write a whole number";
    }
    if (problem.empty()) {
        result = static_cast<std::uint32_t>(number);
    }
    return problem;
}

Problem read_seconds(const std::string& text, Seconds& result) {
    double number = 0.0;
    Problem problem = read_number(text, 0.0, kMaxSeconds, number);
    result = Seconds(number);
    return problem;
}

Problem read_float(const std::string& text, double low, double high, float& result) {
    double number = 0.0;
    Problem problem = read_number(text, low, high, number);
    result = static_cast<float>(number);
    return problem;
}

/// Frames per second; 0: nothing in particular.
template <class Number> Problem read_rate(const std::string& text, Number& result) {
    float number = 0.0F;
    const Problem problem = read_float(text, 0.0, kMaxFps, number);
    if (!problem.empty() || !is_rate_bound(number)) {
        return "write 0, or a number from 0.1 to 1000";
    }
    result = number;
    return {};
}

template <class Value>
Problem read_word(const std::string& text, const std::vector<std::pair<std::string_view, Value>>& words,
                  Value& result) {
    std::string known;
    for (const auto& [word, value] : words) {
        if (word == text) {
            result = value;
            return {};
        }
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    return "write one of " + known;
}

Problem read_grid(const std::string& text, net::Wish& wish) {
    const auto grid = parse_grid(text);
    if (!grid) {
        return "write ROWSxCOLS, as in 3x3";
    }
    wish.rows = grid->rows;
    wish.cols = grid->cols;
    return grid_problem(*grid).value_or("");
}

Problem read_size(const std::string& text, net::Wish& wish) {
    const auto size = parse_grid(text); // WIDTHxHEIGHT reads like ROWSxCOLS
    if (!size || size->rows == 0 || size->cols == 0 || size->rows > kMaxPlaneSide || size->cols > kMaxPlaneSide) {
        return "write WIDTHxHEIGHT, as in 160x90";
    }
    wish.width_px = size->rows;
    wish.height_px = size->cols;
    return {};
}

Problem read_optional(const std::string& text, std::optional<float>& result) {
    float number = 0.0F;
    Problem problem = read_float(text, 0.0, 1000.0, number);
    result = number;
    return problem;
}

/// Takes the text as it is.
template <class Owner> auto text_in(std::string Owner::*member) {
    return [member](const std::string& text, Owner& owner) {
        owner.*member = text;
        return Problem();
    };
}

/// Takes the text as a file's name.
auto file_in(std::filesystem::path net::Access::*member) {
    return [member](const std::string& text, Scenario& scenario) {
        scenario.access.*member = text;
        return Problem();
    };
}

template <class Owner> using Setters = std::map<std::string, std::function<Problem(const std::string&, Owner&)>>;

template <class Owner>
Problem set(const Setters<Owner>& setters, const std::string& key, const std::string& value, Owner& owner) {
    const auto found = setters.find(key);
    if (found != setters.end()) {
        return found->second(value, owner);
    }
    std::string known;
    for (const auto& [name, setter] : setters) {
        known += (known.empty() ? "" : ", ") + name;
    }
    return "no such setting; there are " + known;
}

const Setters<Group>& group_setters() {
    using Text = const std::string&;
    using wire::Decoding;
    static const std::vector<std::pair<std::string_view, net::Mode>> modes{{"views", net::Mode::kViews},
                                                                           {"scene", net::Mode::kScene},
                                                                           {"warp", net::Mode::kWarp}};
    static const std::vector<std::pair<std::string_view, Decoding>> decodings{
        {"full", Decoding::kFull}, {"checksum", Decoding::kChecksum}, {"headers", Decoding::kHeaders}};
    static const std::vector<std::pair<std::string_view, net::PlaneWish>> planes{
        {"g-buffer", net::PlaneWish::kWithGBuffer}, {"illumination", net::PlaneWish::kIllumination}};
    static const std::vector<std::pair<std::string_view, Anchor>> anchors{{"lattice", Anchor::kLattice},
                                                                          {"centre", Anchor::kCentre}};
    static const std::vector<std::pair<std::string_view, bool>> leavings{{"politely", false}, {"abruptly", true}};
    static const Setters<Group> setters{
        {"name", text_in(&Group::name)},
        {"count", [](Text text, Group& group) { return read_count(text, 1, kMaxClients, group.count); }},
        {"channel",
         [](Text text, Group& group) {
             group.wish.channel = text;
             return Problem();
         }},
        {"mode", [](Text text, Group& group) { return read_word(text, modes, group.wish.mode); }},
        {"grid", [](Text text, Group& group) { return read_grid(text, group.wish); }},
        {"size", [](Text text, Group& group) { return read_size(text, group.wish); }},
        {"anchor", [](Text text, Group& group) { return read_word(text, anchors, group.wish.anchor); }},
        {"planes", [](Text text, Group& group) { return read_word(text, planes, group.wish.planes); }},
        {"spacing", [](Text text, Group& group) { return read_optional(text, group.wish.spacing_m); }},
        {"convergence", [](Text text, Group& group) { return read_optional(text, group.wish.convergence_m); }},
        {"fov",
         [](Text text, Group& group) {
             Problem problem = read_float(text, 0.01, 179.0, group.wish.fovy_rad);
             group.wish.fovy_rad *= std::numbers::pi_v<float> / 180.0F;
             return problem;
         }},
        {"max-fps",
         [](Text text, Group& group) { return read_rate(text, group.wish.max_frames_per_second); }},
        {"due-fps", [](Text text, Group& group) { return read_rate(text, group.due_fps); }},
        {"decoding", [](Text text, Group& group) { return read_word(text, decodings, group.decoding); }},
        {"reads-kbit-per-second",
         [](Text text, Group& group) {
             Problem problem = read_number(text, 1.0, 1e9, group.max_bytes_per_second);
             group.max_bytes_per_second *= 1000.0 / 8.0;
             return problem;
         }},
        {"think", [](Text text, Group& group) { return read_seconds(text, group.think); }},
        {"stay", [](Text text, Group& group) { return read_seconds(text, group.stay); }},
        {"away", [](Text text, Group& group) { return read_seconds(text, group.away); }},
        {"leaves", [](Text text, Group& group) { return read_word(text, leavings, group.leaves_abruptly); }},
    };
    return setters;
}

const Setters<Scenario>& scenario_setters() {
    using Text = const std::string&;
    static const Setters<Scenario> setters{
        {"name", text_in(&Scenario::name)},
        {"ramp", [](Text text, Scenario& all) { return read_seconds(text, all.ramp); }},
        {"duration", [](Text text, Scenario& all) { return read_seconds(text, all.duration); }},
        {"seed", [](Text text, Scenario& all) { return read_count(text, 0, UINT32_MAX, all.seed); }},
        {"threads", [](Text text, Scenario& all) { return read_count(text, 0, 256, all.threads); }},
        {"metrics", text_in(&Scenario::metrics_url)},
    };
    return setters;
}

const Setters<Scenario>& target_setters() {
    using Text = const std::string&;
    static const std::vector<std::pair<std::string_view, bool>> switches{{"true", true}, {"false", false}};
    static const Setters<Scenario> setters{
        {"address", text_in(&Scenario::address)},
        {"tls", [](Text text, Scenario& all) { return read_word(text, switches, all.access.uses_tls); }},
        {"tls-ca", file_in(&net::Access::tls_ca)},
        {"tls-cert", file_in(&net::Access::tls_certificate)},
        {"tls-key", file_in(&net::Access::tls_key)},
        {"tls-name",
         [](Text text, Scenario& all) {
             all.access.tls_name = text;
             return Problem();
         }},
        {"token-file", file_in(&net::Access::token_file)},
    };
    return setters;
}

} // namespace

std::uint32_t client_count(const Scenario& scenario) {
    std::uint32_t count = 0;
    for (const Group& group : scenario.groups) {
        count += group.count;
    }
    return count;
}

std::string_view name_of(wire::Decoding decoding) {
    switch (decoding) {
    case wire::Decoding::kFull:
        return "full";
    case wire::Decoding::kChecksum:
        return "checksum";
    case wire::Decoding::kHeaders:
        return "headers";
    }
    return "";
}

std::string_view name_of(net::Mode mode) {
    switch (mode) {
    case net::Mode::kViews:
        return "views";
    case net::Mode::kScene:
        return "scene";
    case net::Mode::kWarp:
        return "warp";
    }
    return "";
}

std::string set_in_group(const std::string& key, const std::string& value, Group& group) {
    return set(group_setters(), key, value, group);
}

std::string set_in_scenario(const std::string& key, const std::string& value, Scenario& scenario) {
    return set(scenario_setters(), key, value, scenario);
}

std::string set_in_target(const std::string& key, const std::string& value, Scenario& scenario) {
    return set(target_setters(), key, value, scenario);
}

std::string add_threshold(const std::string& key, const std::string& value, std::vector<Threshold>& thresholds) {
    double limit = 0.0;
    const std::optional<Threshold> threshold = threshold_of(key, limit);
    if (!threshold) {
        return "no such threshold; there are " + threshold_names();
    }
    Problem problem = read_number(value, 0.0, 1e12, limit);
    thresholds.push_back(*threshold);
    thresholds.back().limit = limit;
    return problem;
}

} // namespace fieldcast::client::load
