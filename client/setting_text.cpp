// SPDX-License-Identifier: Apache-2.0
#include "client/setting_text.h"

#include "core/base/error.h"
#include "core/lightfield/frame_rate.h"

#include <array>
#include <charconv>
#include <numbers>
#include <optional>
#include <vector>

namespace fieldcast::client {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

std::optional<double> number_of(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc{} && end == text.data() + text.size() && value >= 0.0 && value <= 1e9;
    return is_number ? std::optional(value) : std::nullopt;
}

float number_between(const std::string& what, const std::string& text, double smallest, double largest) {
    const auto value = number_of(text);
    if (!value || *value < smallest || *value > largest) {
        throw UserError(what + "=" + text + ": a number from " + std::to_string(smallest) + " to " +
                        std::to_string(largest));
    }
    return static_cast<float>(*value);
}

/// One of two words.
bool is_first_of(const std::string& what, const std::string& word, const char* first, const char* second) {
    if (word != first && word != second) {
        throw UserError(what + "=" + word + ": " + first + " or " + second);
    }
    return word == first;
}

void set_codecs(const std::string& what, const std::string& text, net::Wish& wish) {
    wish.codecs.clear();
    for (const std::string& word : split(text, '+')) {
        wish.codecs.push_back(codec_of(what, word));
    }
}

struct Setting {
    const char* key;
    void (*set)(const std::string& what, const std::string& value, net::Wish& wish);
};

constexpr std::array kSettings{
    Setting{"grid", set_grid},
    Setting{"size", set_size},
    Setting{"spacing", [](const auto& what, const auto& value, auto& wish) {
                wish.spacing_m = number_between(what, value, 0.0, 1000.0);
            }},
    Setting{"convergence", [](const auto& what, const auto& value, auto& wish) {
                wish.convergence_m = number_between(what, value, 0.0, 1e6);
            }},
    Setting{"fov", [](const auto& what, const auto& value, auto& wish) {
                wish.fovy_rad = number_between(what, value, 0.01, 179.0) * std::numbers::pi_v<float> / 180.0F;
            }},
    Setting{"anchor", [](const auto& what, const auto& value, auto& wish) {
                wish.anchor = is_first_of(what, value, "centre", "lattice") ? Anchor::kCentre : Anchor::kLattice;
            }},
    Setting{"mode", [](const auto& what, const auto& value, auto& wish) {
                wish.mode = mode_of(what, value);
            }},
    Setting{"planes", [](const auto& what, const auto& value, auto& wish) {
                wish.planes = planes_of(what, value);
            }},
    Setting{"codec", set_codecs},
    Setting{"quality", [](const auto& what, const auto& value, auto& wish) {
                wish.quality = static_cast<std::uint8_t>(number_between(what, value, 1.0, 100.0));
            }},
    Setting{"max-fps", [](const auto& what, const auto& value, auto& wish) {
                wish.max_frames_per_second = rate_bound(what, value);
            }},
};

/// Sets what `pair`, KEY=VALUE, names among `settings`.
template <class Settings, class Target>
void apply(const std::string& flag, const std::string& pair, const Settings& settings, Target& wish) {
    const std::size_t equals = pair.find('=');
    const std::string key = pair.substr(0, equals);
    std::string known;
    for (const auto& setting : settings) {
        if (equals != std::string::npos && key == setting.key) {
            return setting.set(flag + ": " + key, pair.substr(equals + 1), wish);
        }
        known += std::string(known.empty() ? "" : ", ") + setting.key;
    }
    throw UserError(flag + ": '" + pair + "' is no KEY=VALUE; keys are " + known);
}

struct Bound {
    const char* key;
    void (*set)(const std::string& what, const std::string& value, net::AdaptationWish& wish);
};

void set_least_grid(const std::string& what, const std::string& value, net::AdaptationWish& wish) {
    if (value == "0x0") {
        wish.min_rows = wish.min_cols = 0;
        return;
    }
    const auto grid = parse_grid(value);
    if (!grid) {
        throw UserError(what + "=" + value + ": write ROWSxCOLS, as in 3x3");
    }
    wish.min_rows = grid->rows;
    wish.min_cols = grid->cols;
}

constexpr std::array kBounds{
    Bound{"jpeg", [](const auto& what, const auto& value, auto& wish) {
              wish.allows_jpeg = is_first_of(what, value, "on", "off");
          }},
    Bound{"quality", [](const auto& what, const auto& value, auto& wish) {
              wish.min_quality = static_cast<std::uint8_t>(number_between(what, value, 0.0, 100.0));
          }},
    Bound{"fps", [](const auto& what, const auto& value, auto& wish) {
              wish.min_frames_per_second = rate_bound(what, value);
          }},
    Bound{"height", [](const auto& what, const auto& value, auto& wish) {
              wish.min_view_height_px = static_cast<std::uint32_t>(number_between(what, value, 0.0, kMaxPlaneSide));
          }},
    Bound{"grid", set_least_grid},
    Bound{"scene", [](const auto& what, const auto& value, auto& wish) {
              wish.allows_scene = is_first_of(what, value, "on", "off");
          }},
    Bound{"delay", [](const auto& what, const auto& value, auto& wish) {
              wish.max_queue_delay_ms = static_cast<std::uint32_t>(number_between(what, value, 1.0, 10'000.0));
          }},
};

play::ChangeMoment moment_of(const std::string& flag, const std::string& text) {
    const std::size_t digits = text.find_first_not_of("0123456789.");
    const std::string unit = digits == std::string::npos ? "" : text.substr(digits);
    const auto value = number_of(text.substr(0, digits));
    if (value && unit == "f") {
        return {.frames = static_cast<std::uint64_t>(*value)};
    }
    if (!value || (unit != "s" && unit != "ms")) {
        throw UserError(flag + ": '" + text + "' says when; write 3s, 500ms, or 20f for a number of frames");
    }
    const double milliseconds = unit == "s" ? *value * 1000.0 : *value;
    return {.after = std::chrono::milliseconds(static_cast<std::int64_t>(milliseconds))};
}

} // namespace

float rate_bound(const std::string& what, const std::string& text) {
    const auto value = number_of(text);
    if (!value || !is_rate_bound(static_cast<float>(*value))) {
        throw UserError(what + "=" + text + ": 0, or frames per second from 0.1 on");
    }
    return static_cast<float>(*value);
}

void set_grid(const std::string& what, const std::string& text, net::Wish& wish) {
    const auto grid = parse_grid(text);
    if (!grid) {
        throw UserError(what + " " + text + ": write ROWSxCOLS, as in 4x4");
    }
    if (const auto problem = grid_problem(*grid)) {
        throw UserError(what + ": " + *problem);
    }
    wish.rows = grid->rows;
    wish.cols = grid->cols;
}

/// WIDTHxHEIGHT reads like ROWSxCOLS.
void set_size(const std::string& what, const std::string& text, net::Wish& wish) {
    const auto size = parse_grid(text);
    if (!size || size->rows == 0 || size->cols == 0 || size->rows > kMaxPlaneSide || size->cols > kMaxPlaneSide) {
        throw UserError(what + " " + text + ": write WIDTHxHEIGHT, as in 640x360");
    }
    wish.width_px = size->rows;
    wish.height_px = size->cols;
}

codec::CodecId codec_of(const std::string& what, const std::string& word) {
    if (word == "raw") {
        return codec::CodecId::kRaw;
    }
    if (word == "jpeg") {
        return codec::CodecId::kJpeg;
    }
    if (word == "h264") {
        return codec::CodecId::kH264;
    }
    if (word != "zstd") {
        throw UserError(what + "=" + word + ": zstd, raw, jpeg or h264; several with +");
    }
    return codec::CodecId::kZstdFiltered;
}

net::PlaneWish planes_of(const std::string& what, const std::string& word) {
    if (word == "g-buffer") {
        return net::PlaneWish::kWithGBuffer;
    }
    if (word == "illumination") {
        return net::PlaneWish::kIllumination;
    }
    if (word == "total-light") {
        return net::PlaneWish::kTotalLight;
    }
    throw UserError(what + ": '" + word + "', expected g-buffer, illumination or total-light");
}

net::Mode mode_of(const std::string& what, const std::string& word) {
    if (word == "scene") {
        return net::Mode::kScene;
    }
    if (word == "warp") {
        return net::Mode::kWarp;
    }
    if (word != "views") {
        throw UserError(what + "=" + word + ": views, scene or warp");
    }
    return net::Mode::kViews;
}

play::Change read_change(const std::string& text, const net::Wish& before) {
    const std::string flag = "--change " + text;
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) {
        throw UserError(flag + ": write WHEN:KEY=VALUE, as in 3s:grid=5x5");
    }
    play::Change change{.moment = moment_of(flag, text.substr(0, colon)), .wish = before};
    for (const std::string& pair : split(text.substr(colon + 1), ',')) {
        apply(flag, pair, kSettings, change.wish);
    }
    return change;
}

net::AdaptationWish read_adaptation(const std::string& text) {
    net::AdaptationWish wish;
    for (const std::string& pair : split(text, ',')) {
        if (!text.empty()) {
            apply("--adapt " + text, pair, kBounds, wish);
        }
    }
    return wish;
}

} // namespace fieldcast::client
