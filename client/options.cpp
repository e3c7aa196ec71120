// SPDX-License-Identifier: Apache-2.0
#include "client/options.h"
#include "client/flag_report.h"
#include "client/play/scene_cache.h"
#include "client/setting_text.h"

#include "core/base/bearer_token.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace fieldcast::client {
namespace {

constexpr const char* kExamples = R"(
Examples:
  One frame of nine finished views:
    fieldcast-client --grid 3x3 --size 320x180 --frames 1 --out out/thin
  Fetch the scene and make 25 views on the Vulkan device of this machine:
    fieldcast-client --mode scene --grid 5x5 --size 640x360 --frames 30 --out out/scene --write quilt,exr
  Make 36 views without the scene, from the source's colour and depth:
    fieldcast-client --mode warp --grid 6x6 --codec jpeg,zstd --frames 30
  Make the server send 36 views as JPEG, at about an eighth of the bytes:
    fieldcast-client --grid 6x6 --codec jpeg,zstd --frames 30
  A horizontal sweep for a lenticular display, with all kinds of picture files:
    fieldcast-client --grid 1x45 --frames 1 --write quilt,views,contact-sheet,look-around
  Steer the camera of a channel with --camera-control steered on an orbit round its subject:
    fieldcast-client --grid 3x3 --steer orbit:radius=2,seconds=10 --frames 100
  Change the grid after three seconds and make views here after six, on the same connection:
    fieldcast-client --grid 3x3 --change 3s:grid=5x5 --change 6s:mode=scene --frames 100
  Connect to a remote server with TLS and a token from its operator:
    fieldcast-client --server https://fieldcast.example.org:50151 --token-file token.txt --frames 1

Exit codes: 0 all frames shown, 1 the server or this machine failed, 2 the flags or the request are not valid or not
allowed, 130 interrupted.
)";

/// The command line before it is checked.
struct FlagText {
    std::vector<std::pair<std::string, std::string>> request; ///< keys of net::request_setters() and values
    std::vector<std::string> modes;
    std::vector<std::string> codecs;
    std::vector<std::string> changes;
    std::string adaptation;
    bool adapts = false;
    std::string save = "last";
    std::vector<std::string> write{"quilt", "views"};
    std::string cache;
    double patience_s = 30.0;
    bool no_reconnect = false;
    bool no_residual = false;
    std::string steer;
    bool steers_now = false;
};

/// A flag whose value is a setting of the request.
CLI::Option* add_setting(CLI::App& app, const std::string& flag, const std::string& help, FlagText& text) {
    const auto note = [&text, key = flag.substr(2)](const std::string& value) { text.request.emplace_back(key, value); };
    return app.add_option_function<std::string>(flag, note, help);
}

void add_view_flags(CLI::App& app, FlagText& text) {
    add_setting(app, "--grid", "Grid of views, ROWSxCOLS, at most 72 views.", text)->default_str("4x4");
    add_setting(app, "--size", "Size of one view in pixels, WIDTHxHEIGHT (default: that of the source).", text);
    add_setting(app, "--fov", "Vertical field of view in degrees (default: the source's).", text);
    add_setting(app, "--spacing", "Distance of neighbouring views in metres (default: the channel's).", text);
    add_setting(app, "--convergence", "Depth of zero disparity in metres; 0: parallel cameras.", text);
    add_setting(app, "--anchor", "Position of the source view in the grid: lattice or centre.", text)
        ->default_str("lattice");
    add_setting(app, "--max-fps", "Largest frame rate in frames per second, 0.1 or more; 0: the channel's.", text)
        ->default_str("0");
}

void add_plane_flags(CLI::App& app, FlagText& text) {
    add_setting(app, "--planes",
                "Mode scene: source planes to receive. g-buffer: illumination, depth, normal, id and material; "
                "illumination: illumination only, the client rebuilds the rest; total-light: the same with one plane "
                "of illumination instead of two.",
                text)
        ->default_str("g-buffer");
    add_setting(app, "--normal-bits",
                "Mode scene with g-buffer: bits of each of the two components of a normal, 16 or 8. 8 bits need a "
                "fraction of the bytes and change normals by less than 1 degree.",
                text)
        ->default_str("16");
}

void add_mode_flags(CLI::App& app, FlagText& text, play::PlayOptions& play) {
    app.add_option(
           "--mode", text.modes,
           "Delivery mode. views: the server makes the views; scene: the client makes them with a copy of the scene "
           "and a Vulkan device; warp: the client makes them from colour and depth, without the scene; scene,views or "
           "warp,views: views if there is no Vulkan device.")
        ->delimiter(',')
        ->check(CLI::IsMember(words<DeliveryMode>()))
        ->default_str("views");
    add_plane_flags(app, text);
    app.add_option(
           "--codec", text.codecs,
           "Codecs of views, of the illumination in mode scene or of the colour in mode warp, most wanted first: zstd "
           "(lossless), raw, jpeg, and for views also h264.")
        ->delimiter(',')
        ->check(CLI::IsMember(words<Codec>()))
        ->default_str("zstd");
    add_setting(app, "--quality", "Quality of lossy codecs, 1 to 100 (default: the server's choice).", text);
    app.add_flag("--no-residual", text.no_residual,
                 "Mode warp: do not receive the surfaces that only the corner views of the grid see.");
    app.add_option("--adapt", text.adaptation,
                   "Let the server reduce the stream while the connection is too slow. Optional bounds (default: "
                   "quality=40,fps=2,height=180,grid=3x3,jpeg=on,scene=off,delay=100). The server reduces in this "
                   "order: JPEG, JPEG quality, frame rate, size of views, number of views, mode scene.")
        ->expected(0, 1);
    app.add_option("--change", text.changes,
                   "WHEN:KEY=VALUE,…: change the request on the running stream, as in 3s:grid=5x5 or "
                   "20f:mode=scene,size=320x180. Keys: grid, size, spacing, convergence, fov, anchor, mode, planes, "
                   "codec (zstd+jpeg), quality, max-fps. May be repeated.");
    app.add_option("--device", play.device, "Modes scene and warp: part of the name of the Vulkan device.");
    app.add_option("--traversal", play.traversal, "Mode scene: ray traversal, auto, bvh or rayquery.")
        ->check(CLI::IsMember({"auto", "bvh", "rayquery"}))
        ->capture_default_str();
    app.add_option("--visibility", play.visibility,
                   "Mode scene: visibility method for views, rays, raster, or auto (the faster one).")
        ->check(CLI::IsMember({"auto", "rays", "raster"}))
        ->capture_default_str();
    app.add_option("--cache", text.cache, "Mode scene: folder of fetched scenes (default: ~/.cache/fieldcast).");
}

void add_steering_flags(CLI::App& app, FlagText& text) {
    app.add_option(
        "--steer", text.steer,
        "Steer the channel's camera: orbit:radius=METRES,seconds=SECONDS, a JSON file of timed poses, or - for one "
        "pose per line from standard input.");
    app.add_flag("--steer-now", text.steers_now,
                 "Fail if another client is steering, instead of waiting for the camera.");
}

void add_access_flags(CLI::App& app, net::Access& access) {
    app.add_flag("--tls", access.uses_tls, "Encrypt the connection, as --server https://HOST:PORT does.");
    app.add_option("--tls-ca", access.tls_ca,
                   "PEM file of authorities for the server's certificate (default: those that this system trusts).");
    app.add_option("--tls-cert", access.tls_certificate,
                   "PEM file of the client certificate, if the server requires one.");
    app.add_option("--tls-key", access.tls_key, "PEM file of the private key for --tls-cert.");
    app.add_option("--tls-name", access.tls_name, "Name in the server's certificate (default: the host of --server).");
    app.add_option("--token-file", access.token_file,
                   "File with the token for the server (default: the variable FIELDCAST_TOKEN).");
}

void add_server_flags(CLI::App& app, FlagText& text, play::PlayOptions& play) {
    app.add_option("--server", play.server.address, "Address of the server, HOST:PORT or https://HOST:PORT.")
        ->capture_default_str();
    add_access_flags(app, play.server.access);
    app.add_option("--channel", play.request.channel, "Name of the channel (default: the server's first).");
    app.add_flag("--no-reconnect", text.no_reconnect,
                 "Fail if the server cannot be reached or the connection ends, instead of reconnecting.");
    app.add_option("--patience", text.patience_s,
                   "Seconds of unsuccessful connection attempts after which the client gives up, 0 to 1e6.")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--frames", play.frames, "Number of frames to show; 0: until interrupted.")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
}

void add_output_flags(CLI::App& app, FlagText& text, Options& options) {
    app.add_option("--out", options.play.out, "Folder for the files.")->capture_default_str();
    app.add_option("--save", text.save,
                   "Frames to write. last: the last frame; all: every frame, in a folder of its own; none.")
        ->check(CLI::IsMember({"last", "all", "none"}))
        ->capture_default_str();
    app.add_option("--write", text.write, "Files to write per frame: quilt,views,contact-sheet,look-around,exr.")
        ->delimiter(',')
        ->check(CLI::IsMember({"quilt", "views", "contact-sheet", "look-around", "exr"}))
        ->capture_default_str();
    app.add_option("--json", options.json, "Write the statistics to this JSON file.");
    app.add_option("--frame-log", options.play.timing_files.frame_log,
                   "FILE.csv or FILE.jsonl: one row of times per frame, from the pose on the server to the display "
                   "here.");
    app.add_option("--trace", options.play.timing_files.trace,
                   "FILE.json: the times of --frame-log as a timeline for ui.perfetto.dev.");
    app.add_flag("--verbose", options.is_verbose, "Log every frame (log level debug).");
}

bool contains(const std::vector<std::string>& words, const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

image::LightFieldProducts read_products(const std::vector<std::string>& words) {
    image::LightFieldProducts products;
    products.quilt = contains(words, "quilt");
    products.views = contains(words, "views");
    products.contact_sheet = contains(words, "contact-sheet");
    products.look_around = contains(words, "look-around");
    products.source_exr = contains(words, "exr");
    return products;
}

void read_access(play::ServerOptions& server) {
    net::Access& access = server.access;
    server.address = net::without_scheme(server.address, access);
    if (access.tls_certificate.empty() != access.tls_key.empty()) {
        throw UserError("--tls-cert and --tls-key belong together");
    }
    const bool has_tls_flags = !access.tls_ca.empty() || !access.tls_key.empty() || !access.tls_name.empty();
    if (has_tls_flags && !access.uses_tls) {
        throw UserError("--tls-ca, --tls-cert, --tls-key and --tls-name need --tls or --server https://HOST:PORT");
    }
    access.token = token_of_environment();
}

/// Each --change is applied to the request that the one before it left.
void read_changes(const FlagText& text, play::PlayOptions& play) {
    for (const std::string& change : text.changes) {
        play.changes.push_back(read_change(change, play.changes.empty() ? play.request : play.changes.back().request));
    }
}

void read_text(const FlagText& text, Options& options) {
    read_access(options.play.server);
    net::Request& request = options.play.request;
    for (const auto& [key, value] : text.request) {
        set_in_request(key, value, request);
    }
    if (!text.modes.empty()) {
        set_in_request("mode", text.modes.front(), request);
    }
    request.has_residual = !text.no_residual;
    options.falls_back_to_views = is_made_by_client(request.mode) && contains(text.modes, "views");
    if (!text.codecs.empty()) {
        std::string codecs;
        for (const std::string& word : text.codecs) {
            codecs += (codecs.empty() ? "" : "+") + word;
        }
        set_in_request("codec", codecs, request);
    }
    options.play.server.reconnects = !text.no_reconnect;
    options.play.server.patience = std::chrono::milliseconds(static_cast<std::int64_t>(text.patience_s * 1000.0));
    options.play.save = text.save == "all"    ? play::Save::kAll
                        : text.save == "none" ? play::Save::kNone
                                              : play::Save::kLast;
    options.play.products = read_products(text.write);
    if (const auto problem = timing::problem_with(options.play.timing_files, "--frame-log", "--trace")) {
        throw UserError(*problem);
    }
    if (text.adapts) {
        request.adaptation = read_adaptation(text.adaptation);
    }
    read_changes(text, options.play);
    if (options.play.products.source_exr && !row_of(request.mode).needs_scene) {
        throw UserError("--write exr needs --mode scene: other modes do not receive the planes of the source");
    }
    if (!text.steer.empty()) {
        options.play.steering = {.poses = play::read_camera_path(text.steer), .waits = !text.steers_now};
    }
    if (needs_scene(options.play)) {
        options.play.cache_folder = text.cache.empty() ? play::SceneCache::default_folder().string() : text.cache;
    }
}

} // namespace

Invocation read_options(int argc, const char* const* argv) {
    CLI::App app("Shows the light field of a Fieldcast server: receives or makes a grid of views and writes image "
                 "files.",
                 "fieldcast-client");
    app.footer(kExamples);
    Options options;
    FlagText text;
    add_server_flags(app, text, options.play);
    add_view_flags(app, text);
    add_mode_flags(app, text, options.play);
    add_steering_flags(app, text);
    add_output_flags(app, text, options);
    try {
        app.parse(argc, argv);
        text.adapts = app.count("--adapt") > 0;
        read_text(text, options);
        return {options, "", 0};
    } catch (const CLI::ParseError& error) {
        const FlagReport report = report_of(app, error);
        return {std::nullopt, report.text, report.exit_code};
    } catch (const UserError& error) {
        return {std::nullopt, std::string(error.what()) + "\n", 2};
    }
}

} // namespace fieldcast::client
