// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench quality`: errors of views against references (the paper's table 1), and `reference`, which makes the
// references beforehand.
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/references.h"
#include "bench/scores.h"
#include "core/base/error.h"
#include "core/image/metrics.h"
#include "core/lightfield/presets.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iomanip>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct QualityOptions {
    std::string scene = "scenes/atelier/atelier.gltf";
    std::string protocol = "reduced";
    std::string size; ///< empty: the protocol's
    std::string device;
    std::string references = ".cache/references";
    std::string json;
    std::string csv;
    std::string out;
    std::vector<std::string> presets{"reprojected", "svgf", "bmfr", "ours"};
    std::uint32_t reference_samples = 0; ///< 0: the protocol's
    double exposure = 0.0;
    double indirect_clamp = -1.0; ///< < 0: the presets'
    bool renders_scored_views_only = false;
};

volatile std::sig_atomic_t is_interrupted = 0;

/// While it lives, Ctrl-C asks for an end instead of causing one.
class InterruptGuard {
public:
    InterruptGuard() : before_(std::signal(SIGINT, [](int) { is_interrupted = 1; })) {}
    ~InterruptGuard() { std::signal(SIGINT, before_); }
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

private:
    void (*before_)(int);
};

/// The protocol with what the command line says otherwise.
Protocol chosen_protocol(const QualityOptions& options) {
    Protocol protocol = find_protocol(options.protocol);
    if (!options.size.empty()) {
        protocol.size = parse_size("--size", options.size);
    }
    if (options.reference_samples > 0) {
        protocol.reference_samples = options.reference_samples;
    }
    return protocol;
}

std::string describe(const Protocol& protocol) {
    return protocol.name + " protocol: " + std::to_string(protocol.size.width_px) + "x" +
           std::to_string(protocol.size.height_px) + ", " + std::to_string(protocol.frames.size()) + " frames, " +
           std::to_string(protocol.views.size()) + " views of 6x6, references of " +
           std::to_string(protocol.reference_samples) + " samples";
}

/// Shows how far the references are and when they will be done.
class ReferenceProgress {
public:
    explicit ReferenceProgress(double samples) : left_(samples), begin_(std::chrono::steady_clock::now()) {}

    void add(double samples) {
        done_ += samples;
        left_ -= samples;
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
        std::cerr << "\rreferences: " << static_cast<int>(100.0 * done_ / std::max(1.0, done_ + left_)) << " %, "
                  << static_cast<int>(spent.count() / std::max(1.0, done_) * left_ / 60.0 + 0.5) << " minutes left   "
                  << std::flush;
    }

private:
    double done_ = 0.0;
    double left_;
    std::chrono::steady_clock::time_point begin_;
};

/// Makes all references that are missing. False: interrupted.
bool make_references(LightFieldScene& scene, References& references, const Protocol& protocol) {
    double missing = 0.0;
    for (const std::uint32_t frame : protocol.frames) {
        for (const LatticePosition view : protocol.views) {
            const std::uint32_t existing = references.samples_of(frame, view);
            missing += protocol.reference_samples - std::min(existing, protocol.reference_samples);
        }
    }
    ReferenceProgress progress(missing);
    const InterruptGuard guard;
    for (const std::uint32_t frame : protocol.frames) {
        scene.pose(frame);
        for (const LatticePosition view : protocol.views) {
            std::uint32_t before = references.samples_of(frame, view);
            const auto report = [&](std::uint32_t done) {
                progress.add(done - before);
                before = done;
                return is_interrupted == 0;
            };
            if (!references.get(frame, view, protocol.reference_samples, report)) {
                std::cerr << "\ninterrupted: what was made is kept, the same command goes on from there\n";
                return false;
            }
        }
    }
    if (missing > 0.0) {
        std::cerr << '\n';
    }
    return true;
}

/// One row of the table.
struct Row {
    std::string name;
    std::unique_ptr<LightFieldRun> run{}; ///< none: the views path traced with one sample
    Scores scores{};
    std::vector<double> frame_ms{};
    double traced = 0.0;
    double pixels = 0.0;
};

image::RgbF32 to_image(const Size& size, std::vector<glm::vec3> pixels) {
    return {size.width_px, size.height_px, std::move(pixels)};
}

class QualityRun {
public:
    QualityRun(const gpu::Device& device, const QualityOptions& options)
        : options_(options), protocol_(chosen_protocol(options)),
          scene_(device, {.file = options.scene, .size = protocol_.size}),
          references_(device, scene_, options.references), one_sample_(device, scene_.gpu_scene()) {
        RenderSettings settings;
        settings.exposure = static_cast<float>(options.exposure);
        exposure_ = options.exposure > 0.0 ? settings.exposure
                                           : LightFieldRun(device, scene_, settings, false).header().settings.exposure;
        rows_.push_back({.name = "1 spp"});
        for (const std::string& name : options.presets) {
            const auto preset = find_preset(name, scene_.grid().rows, scene_.grid().cols);
            if (!preset) {
                throw UserError("--presets " + name + ": expected some of " + preset_names());
            }
            RenderSettings chosen = preset->settings;
            chosen.exposure = exposure_;
            if (options.indirect_clamp >= 0.0) {
                chosen.indirect_clamp = static_cast<float>(options.indirect_clamp);
            }
            rows_.push_back({.name = name});
            rows_.back().run = std::make_unique<LightFieldRun>(device, scene_, chosen, preset->has_guard_band);
        }
    }

    const Protocol& protocol() const { return protocol_; }
    bool make_references() { return bench::make_references(scene_, references_, protocol_); }

    /// All rows render every frame, interleaved; the protocol's are scored.
    void score() {
        const std::vector<LatticePosition> positions = rendered_views();
        for (std::uint32_t frame = 0; frame <= protocol_.frames.back(); ++frame) {
            scene_.pose(frame);
            const bool is_scored = std::ranges::find(protocol_.frames, frame) != protocol_.frames.end();
            for (Row& row : rows_) {
                const Views views = row.run ? row.run->render(frame, positions) : Views{};
                if (is_scored) {
                    score_row(row, frame, views);
                }
            }
            std::cerr << "\rframe " << frame + 1 << " of " << protocol_.frames.back() + 1 << std::flush;
        }
        std::cerr << '\n';
    }

    nlohmann::ordered_json result(const gpu::Device& device) const {
        nlohmann::ordered_json json{{"device", device.info().name + ", " + device.info().driver},
                                    {"scene", options_.scene},
                                    {"protocol", describe(protocol_)},
                                    {"exposure", exposure_}};
        for (const Row& row : rows_) {
            nlohmann::ordered_json values = row.scores.to_json();
            values["frame_ms"] = row.frame_ms.empty() ? 0.0 : median(row.frame_ms);
            values["traced_share"] = row.run ? row.traced / row.pixels : 1.0;
            json["rows"][row.name] = values;
        }
        return json;
    }

    std::uint64_t invalid_samples() const {
        std::uint64_t count = one_sample_.invalid_sample_count();
        for (const Row& row : rows_) {
            count += row.run ? row.run->invalid_samples() : 0;
        }
        return count;
    }

private:
    std::vector<LatticePosition> rendered_views() const {
        return options_.renders_scored_views_only ? protocol_.views : lattice_positions(scene_.grid());
    }

    void score_row(Row& row, std::uint32_t frame, const Views& views) {
        double ms = 0.0;
        for (const StageTime& time : views.header.render_times) {
            ms += time.ms;
        }
        if (row.run) {
            row.frame_ms.push_back(ms);
            row.traced += static_cast<double>(row.run->grid_renderer().hole_counts().traced);
            const auto synthesised = static_cast<double>(
                std::ranges::count_if(rendered_views(), [](LatticePosition p) { return p != LatticePosition{}; }));
            row.pixels += synthesised * protocol_.size.width_px * protocol_.size.height_px;
        }
        for (const LatticePosition position : protocol_.views) {
            const auto reference = references_.get(frame, position, protocol_.reference_samples, {});
            image::RgbF32 picture;
            std::vector<bool> holes;
            if (row.run) {
                const auto positions = rendered_views();
                const auto index =
                    static_cast<std::size_t>(std::ranges::find(positions, position) - positions.begin());
                picture = to_image(protocol_.size, row.run->grid_renderer().linear_view(index).pixels);
                holes = row.run->grid_renderer().hole_mask(index);
            } else {
                one_sample_.start(scene_.view(position));
                RenderSettings settings;
                settings.exposure = exposure_;
                one_sample_.accumulate(settings, frame);
                picture = to_image(protocol_.size, one_sample_.image());
            }
            row.scores.add(picture, *reference, exposure_, holes);
            if (!options_.out.empty()) {
                write(row.name, frame, position, picture);
                write("reference", frame, position, *reference);
            }
        }
    }

    void write(const std::string& row, std::uint32_t frame, LatticePosition position, const image::RgbF32& picture) const {
        const ViewGrid grid;
        const LatticePosition first = lattice_position(grid, 0, 0);
        const std::filesystem::path folder = std::filesystem::path(options_.out) / row;
        std::filesystem::create_directories(folder);
        const std::string name = "frame" + std::to_string(frame) + "_r" +
                                 std::to_string((position.row_halves - first.row_halves) / 2) + "_c" +
                                 std::to_string((position.col_halves - first.col_halves) / 2);
        Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, picture.width_px, picture.height_px, {}};
        for (const glm::vec3& pixel : image::display_image(picture, exposure_).pixels) {
            for (int c = 0; c < 3; ++c) {
                plane.bytes.push_back(static_cast<std::byte>(std::lround(pixel[c] * 255.0F)));
            }
        }
        image::write_png(folder / (name + ".png"), plane);
    }

    QualityOptions options_;
    Protocol protocol_;
    LightFieldScene scene_;
    References references_;
    render::ReferenceRenderer one_sample_;
    float exposure_ = 1.0F;
    std::vector<Row> rows_;
};

void print_table(const nlohmann::ordered_json& json) {
    std::cout << "input            RMSE    SSIM   relMSE   holes  reused  border   traced   frame\n" << std::fixed;
    for (const auto& [name, row] : json["rows"].items()) {
        const auto of = [&](const char* key) { return row[key].template get<double>(); };
        std::cout << std::left << std::setw(13) << name << std::right << std::setprecision(4) << std::setw(8) << of("rmse")
                  << std::setw(8) << of("ssim") << std::setw(9) << of("relative_mse") << std::setw(8) << of("rmse_holes")
                  << std::setw(8) << of("rmse_reused") << std::setw(8) << of("rmse_border") << std::setprecision(2)
                  << std::setw(7) << 100.0 * of("traced_share") << " %" << std::setprecision(0) << std::setw(6)
                  << of("frame_ms") << " ms\n";
    }
}

void write_csv(const std::string& file, const nlohmann::ordered_json& json) {
    std::ofstream stream(file);
    stream << "device,scene,protocol,input,rmse,ssim,relative_mse,rmse_holes,rmse_reused,rmse_border,frame_ms,traced_share\n";
    for (const auto& [name, row] : json["rows"].items()) {
        stream << json["device"] << ',' << json["scene"] << ',' << json["protocol"] << ",\"" << name << '"';
        for (const auto& [key, value] : row.items()) {
            stream << ',' << value.template get<double>();
        }
        stream << '\n';
    }
    if (!stream.flush()) {
        throw UserError("--csv " + file + ": cannot be written");
    }
}

void run_quality(const QualityOptions& options) {
    const gpu::Device device({.name_contains = options.device});
    QualityRun run(device, options);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << options.scene << ", " << describe(run.protocol()) << std::endl;
    if (!run.make_references()) {
        return;
    }
    run.score();
    const nlohmann::ordered_json json = run.result(device);
    print_table(json);
    std::cout << "invalid samples: " << run.invalid_samples() << '\n';
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.csv.empty()) {
        write_csv(options.csv, json);
    }
}

void run_reference(const QualityOptions& options) {
    const gpu::Device device({.name_contains = options.device});
    const Protocol protocol = chosen_protocol(options);
    LightFieldScene scene(device, {.file = options.scene, .size = protocol.size});
    References references(device, scene, options.references);
    std::cout << options.scene << ", " << describe(protocol) << std::endl;
    make_references(scene, references, protocol);
}

void add_common_options(CLI::App& command, QualityOptions& options) {
    command.add_option("--scene", options.scene, "glTF file")->capture_default_str();
    command.add_option("--protocol", options.protocol, "reduced (two processor cores) or full (a GPU)")
        ->capture_default_str();
    command.add_option("--size", options.size, "size of source and views; default: the protocol's");
    command.add_option("--spp", options.reference_samples, "samples of the references; default: the protocol's")
        ->check(CLI::Range(1, 1 << 20));
    command.add_option("--references", options.references, "folder of the references, which are kept")
        ->capture_default_str();
    command.add_option("--device", options.device, "part of the Vulkan device's name");
}

} // namespace

void add_quality_command(CLI::App& app) {
    auto options = std::make_shared<QualityOptions>();
    CLI::App* command = app.add_subcommand("quality", "RMSE and SSIM of views against references (the paper's table 1)");
    add_common_options(*command, *options);
    command->add_option("--presets", options->presets, "rows of the table besides 1 spp: " + preset_names())
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--exposure", options->exposure, "default: automatic, from the first frame");
    command->add_option("--indirect-clamp", options->indirect_clamp, "instead of the presets'; 0: none");
    command->add_flag("--scored-views", options->renders_scored_views_only,
                      "render only the views that are scored: faster, but frame times and shares are not those of 6x6");
    command->add_option("--json", options->json, "write the results to this file");
    command->add_option("--csv", options->csv, "write the table to this file");
    command->add_option("--out", options->out, "write the scored views to this folder");
    command->callback([options] { run_quality(*options); });
}

void add_reference_command(CLI::App& app) {
    auto options = std::make_shared<QualityOptions>();
    CLI::App* command =
        app.add_subcommand("reference", "Make the references of `quality`; can be interrupted, goes on where it was");
    add_common_options(*command, *options);
    command->callback([options] { run_reference(*options); });
}

} // namespace fieldcast::bench
