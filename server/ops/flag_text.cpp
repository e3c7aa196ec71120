// SPDX-License-Identifier: Apache-2.0
#include "server/ops/flag_text.h"

#include "core/lightfield/presets.h"
#include "core/lightfield/sources.h"
#include "server/ops/camera_flags.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

namespace fieldcast::ops {

namespace {

using Problems = std::vector<std::string>;

template <class T> std::optional<T> read_number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Exactly as many comma-separated numbers as there is room for.
template <class T> bool read_list(std::string_view text, std::span<T> numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const bool is_last = i + 1 == numbers.size();
        const std::size_t end = is_last ? text.size() : text.find(',');
        const auto number = end == std::string_view::npos ? std::nullopt : read_number<T>(text.substr(0, end));
        if (!number) {
            return false;
        }
        numbers[i] = *number;
        text.remove_prefix(is_last ? end : end + 1);
    }
    return true;
}

template <class T> struct Word {
    std::string_view word;
    T value;
};

constexpr std::array kSamplers{Word{.word = "z-sobol", .value = Sampler::kZSobol},
                               Word{.word = "sobol", .value = Sampler::kSobol}};
constexpr std::array kSwitch{Word{.word = "off", .value = false}, Word{.word = "on", .value = true}};

template <class T, std::size_t kCount> std::string word_of(T value, const std::array<Word<T>, kCount>& words) {
    return std::string(std::ranges::find(words, value, &Word<T>::value)->word);
}

template <class T, std::size_t kCount>
void read_word(const char* flag, const std::string& text, const std::array<Word<T>, kCount>& words, T& value,
               Problems& problems) {
    std::string allowed;
    for (const Word<T>& word : words) {
        if (word.word == text) {
            value = word.value;
            return;
        }
        allowed += (allowed.empty() ? "" : ", ") + std::string(word.word);
    }
    problems.push_back(std::string(flag) + " " + text + ": one of " + allowed);
}

/// Of an enumeration with words of its own.
template <class Enum> void read_word(const char* flag, const std::string& text, Enum& value, Problems& problems) {
    if (const auto read = from_word<Enum>(text)) {
        value = *read;
    } else {
        problems.push_back(std::string(flag) + " " + text + ": one of " + alternatives<Enum>());
    }
}

void read_channels(const FlagText& text, Config& config, Problems& problems) {
    for (const std::string& scene : text.scenes) {
        const std::filesystem::path file(scene);
        config.channels.push_back({.name = file.stem().string(), .scene = file});
    }
    for (const std::string& channel : text.channels) {
        const std::size_t equals = channel.find('=');
        if (equals == std::string::npos) {
            problems.push_back("--channel " + channel + ": write NAME=FILE");
            continue;
        }
        config.channels.push_back({.name = channel.substr(0, equals), .scene = channel.substr(equals + 1)});
    }
}

void read_sky(const FlagText& text, Config& config, Problems& problems) {
    std::array<float, 3> sky{};
    if (text.sky.empty()) {
        return;
    }
    if (!read_list<float>(text.sky, sky)) {
        problems.push_back("--sky " + text.sky + ": write R,G,B, as in 0.5,0.7,1");
        return;
    }
    config.sky = glm::vec3(sky[0], sky[1], sky[2]);
}

void read_guard_band(const FlagText& text, Config& config, Problems& problems) {
    std::array<std::uint32_t, 4> sides{};
    if (text.guard_band == "auto") {
        return;
    }
    config.guard_band_mode = GuardBandMode::kFixed;
    if (text.guard_band != "none" && !read_list<std::uint32_t>(text.guard_band, sides)) {
        problems.push_back("--guard-band " + text.guard_band + ": auto, none, or LEFT,RIGHT,TOP,BOTTOM in pixels");
    }
    config.guard_band = {.left_px = sides[0], .right_px = sides[1], .top_px = sides[2], .bottom_px = sides[3]};
}

void read_lattice(const FlagText& text, Config& config, Problems& problems) {
    if (const auto size = parse_size(text.size)) {
        config.width_px = size->x;
        config.height_px = size->y;
    } else {
        problems.push_back("--size " + text.size + ": write WIDTHxHEIGHT, as in 1280x720");
    }
    if (const auto grid = parse_grid(text.largest_grid)) {
        config.largest_grid = *grid;
    } else {
        problems.push_back("--largest-grid " + text.largest_grid + ": write ROWSxCOLS, as in 6x6");
    }
    if (auto positions = parse_sources(text.sources, config.largest_grid)) {
        config.source_positions = std::move(*positions);
    } else {
        problems.push_back(
            "--sources " + text.sources +
            ": middle, top-left, diagonal, triangle, corners, or views of the largest grid as in \"0,0;5,5\"");
    }
    config.has_convergence = !text.convergence.empty();
    if (const auto metres = read_number<float>(text.convergence)) {
        config.lattice.convergence_m = *metres;
    } else if (config.has_convergence) {
        problems.push_back("--convergence " + text.convergence + ": a number of metres, or inf");
    }
    if (text.exposure == "auto") {
        return;
    }
    config.has_auto_exposure = false;
    if (const auto exposure = read_number<float>(text.exposure)) {
        config.settings.exposure = *exposure;
    } else {
        problems.push_back("--exposure " + text.exposure + ": 'auto' or a number above 0");
    }
}

std::optional<glm::vec3> read_point(const char* flag, const std::string& text, Problems& problems) {
    std::array<float, 3> point{};
    if (text.empty()) {
        return std::nullopt;
    }
    if (!read_list<float>(text, point)) {
        problems.push_back(std::string(flag) + " " + text + ": write X,Y,Z in metres, as in 0,1.6,4");
        return std::nullopt;
    }
    return glm::vec3(point[0], point[1], point[2]);
}

/// After read_sky().
void read_environment(const FlagText& text, Config& config) {
    if (text.environment == "studio") {
        config.surroundings = scene::Surroundings::kStudio;
    } else if (text.environment == "sky" || text.environment == "none" || (text.environment.empty() && config.sky)) {
        config.surroundings = scene::Surroundings::kSky;
    } else if (!text.environment.empty()) {
        config.environment = text.environment;
    }
    if (text.environment == "none") {
        config.sky = glm::vec3(0.0F);
    }
}

void read_framing(const FlagText& text, Config& config, Problems& problems) {
    config.framing.look_from = read_point("--look-from", text.look_from, problems);
    config.framing.look_at = read_point("--look-at", text.look_at, problems);
    if (text.fov_deg) {
        config.framing.fovy_rad = *text.fov_deg * std::numbers::pi_v<float> / 180.0F;
    }
}

void read_listen(const FlagText& text, Config& config, Problems& problems) {
    if (const auto address = parse_host_port(text.listen)) {
        config.listen = *address;
    } else {
        problems.push_back("--listen " + text.listen + ": write HOST:PORT, as in 127.0.0.1:50151 or [::1]:50151");
    }
    config.metrics_listen = parse_host_port(text.metrics_listen);
    if (!config.metrics_listen && !text.metrics_listen.empty()) {
        problems.push_back("--metrics-listen " + text.metrics_listen + ": write HOST:PORT, as in 127.0.0.1:9464");
    }
    if (!text.metrics_port_file.empty()) {
        config.metrics_port_file = text.metrics_port_file;
    }
    config.timing_files = {.frame_log = text.frame_log, .trace = text.trace};
}

void read_security(const FlagText& text, Config& config, Problems& problems) {
    if (!text.tokens.empty()) {
        config.security.tokens = text.tokens;
    }
    if (text.tls_cert.empty() != text.tls_key.empty()) {
        problems.emplace_back(text.tls_key.empty() ? "--tls-cert needs --tls-key" : "--tls-key needs --tls-cert");
        return;
    }
    if (text.tls_cert.empty()) {
        if (!text.tls_client_ca.empty()) {
            problems.emplace_back("--tls-client-ca needs --tls-cert and --tls-key");
        }
        return;
    }
    config.security.certificates = {.certificate = text.tls_cert, .key = text.tls_key, .client_ca = std::nullopt};
    if (!text.tls_client_ca.empty()) {
        config.security.certificates->client_ca = text.tls_client_ca;
    }
}

void read_holes(const FlagText& text, Config& config, Problems& problems) { // after the grid
    const auto holes = parse_hole_filling(text.holes, config.largest_grid.rows, config.largest_grid.cols);
    if (!holes) {
        problems.push_back("--holes " + text.holes +
                           ": write all, none, or a list of previous,isolated,cascade,source,denoise");
        return;
    }
    config.settings.holes = *holes;
}

void read_preset(const FlagText& text, Problems& problems) {
    if (!find_preset(text.preset, 1, 1)) {
        problems.push_back("--preset " + text.preset + ": one of " + preset_names());
    }
}

} // namespace

void apply_preset(FlagText& text, Config& config) {
    const auto preset = find_preset(text.preset, config.largest_grid.rows, config.largest_grid.cols);
    if (!preset) {
        return;
    }
    config.settings = preset->settings;
    text.denoiser = word_of(preset->settings.denoiser);
    text.sampler = word_of(preset->settings.sampler, kSamplers);
    text.reflections = word_of(preset->settings.reflections, kSwitch);
    text.each_light_kind = word_of(preset->settings.light_sampling.each_kind, kSwitch);
    text.history_light = word_of(preset->settings.history_light, kSwitch);
    text.denoise = word_of(preset->settings.denoised_images);
    text.accumulate_views = word_of(preset->settings.accumulate_views, kSwitch);
    text.holes = preset->settings.holes == HoleFilling::path_traced() ? "none" : "all";
    text.guard_band = preset->has_guard_band ? "auto" : "none";
    text.sources = preset->sources;
}

void read_text(const FlagText& text, Config& config, Problems& problems) {
    read_preset(text, problems);
    read_channels(text, config, problems);
    read_camera_controls(text, config, problems);
    read_sky(text, config, problems);
    read_guard_band(text, config, problems);
    read_lattice(text, config, problems);
    read_framing(text, config, problems);
    read_holes(text, config, problems);
    read_listen(text, config, problems);
    read_security(text, config, problems);
    read_recordings(text.recording, config, problems);
    read_environment(text, config);
    if (!text.port_file.empty()) {
        config.port_file = text.port_file;
    }
    config.settings.next_event_estimation = !text.lacks_next_event_estimation;
    constexpr std::array kToneMaps{Word{.word = "srgb", .value = ToneMap::kClampSrgb},
                                   Word{.word = "aces", .value = ToneMap::kAces}};
    constexpr std::array kClocks{Word{.word = "real", .value = ClockMode::kReal},
                                 Word{.word = "frames", .value = ClockMode::kFrames}};
    constexpr std::array kLevels{
        Word{.word = "debug", .value = log::Level::kDebug}, Word{.word = "info", .value = log::Level::kInfo},
        Word{.word = "warn", .value = log::Level::kWarn}, Word{.word = "error", .value = log::Level::kError}};
    read_word("--denoiser", text.denoiser, config.settings.denoiser, problems);
    read_word("--each-light-kind", text.each_light_kind, kSwitch, config.settings.light_sampling.each_kind, problems);
    read_word("--history-light", text.history_light, kSwitch, config.settings.history_light, problems);
    read_word("--reflections", text.reflections, kSwitch, config.settings.reflections, problems);
    read_word("--denoise", text.denoise, config.settings.denoised_images, problems);
    read_word("--accumulate-views", text.accumulate_views, kSwitch, config.settings.accumulate_views, problems);
    read_word("--tone-map", text.tone_map, kToneMaps, config.settings.tone_map, problems);
    read_word("--sampler", text.sampler, kSamplers, config.settings.sampler, problems);
    read_word("--clock", text.clock, kClocks, config.clock, problems);
    constexpr std::array kFormats{Word{.word = "text", .value = log::Format::kText},
                                  Word{.word = "json", .value = log::Format::kJson}};
    read_word("--log-format", text.log_format, kFormats, config.log_format, problems);
    read_word("--log-level", text.log_level, kLevels, config.log_level, problems);
}

image::LightFieldProducts read_products(const std::vector<std::string>& words) {
    const auto has = [&](const char* word) { return std::ranges::find(words, word) != words.end(); };
    return {.quilt = has("quilt"),
            .views = has("views"),
            .contact_sheet = has("contact-sheet"),
            .look_around = has("look-around"),
            .source_exr = has("exr")};
}

} // namespace fieldcast::ops
