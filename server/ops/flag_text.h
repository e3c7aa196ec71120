// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/light_field_files.h"
#include "server/ops/config.h"
#include "server/ops/recording_flags.h"

#include <string>
#include <vector>

namespace fieldcast::ops {

/// Flags as they were typed, where the text needs reading; defaults are those of --help.
struct FlagText {
    std::vector<std::string> scenes;
    std::vector<std::string> channels; ///< NAME=FILE
    std::vector<std::string> camera_controls; ///< CONTROL, or NAME=CONTROL
    double steering_lease_s = 5.0;
    std::string environment;
    std::string sky; ///< R,G,B
    std::string size = "1280x720";
    std::string convergence; ///< empty: inf, or as the scene's depths have it
    std::string look_from;
    std::string look_at;
    std::optional<float> fov_deg;
    std::string largest_grid = "6x6";
    std::string sources = "middle";
    bool lacks_next_event_estimation = false;
    std::string reflections = "on";
    std::string each_light_kind = "on";
    std::string history_light = "on";
    std::string preset = "default"; ///< what other flags' defaults come from
    std::string denoiser = "svgf+";
    std::string denoise = "source";
    std::string accumulate_views = "off";
    std::string holes = "all";
    std::string sampler = "z-sobol";
    std::string exposure = "auto";
    std::string tone_map = "srgb";
    std::string guard_band = "auto";
    std::string clock = "real";
    std::string listen = "127.0.0.1:50151";
    std::string port_file;
    std::string tls_cert;
    std::string tls_key;
    std::string tls_client_ca;
    std::string tokens;
    std::string metrics_listen;
    std::string metrics_port_file;
    RecordingText recording;
    std::string frame_log;
    std::string trace;
    std::string log_level = "info";
    std::string log_format = "text";
};

/// Defaults as the preset `text.preset` has them; nothing if there is no such preset.
void apply_preset(FlagText& text, Config& config);

/// Fills `config` from `text`; adds a line to `problems` for everything that cannot be read.
void read_text(const FlagText& text, Config& config, std::vector<std::string>& problems);

/// What `render --write` names.
image::LightFieldProducts read_products(const std::vector<std::string>& words);

} // namespace fieldcast::ops
