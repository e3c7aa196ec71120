// SPDX-License-Identifier: Apache-2.0
#include "bench/references.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "core/base/error.h"

#include <chrono>
#include <fstream>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kBatch = 16; // samples between looks at the clock
constexpr std::uint32_t kSeed = 0x5EED;
constexpr std::chrono::seconds kSaveInterval{30};

/// Other noise in each picture: equal noise would neither average out in refocused images nor show as change over time.
std::uint32_t seed_of(std::uint32_t frame, LatticePosition position) {
    const ViewIndex index = view_index(position);
    return kSeed + 4096U * frame + static_cast<std::uint32_t>(64 * index.row + index.col);
}

std::string hex(const scene::SceneHash& hash) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (const auto byte : hash) {
        text += kDigits[static_cast<unsigned>(byte) >> 4U];
        text += kDigits[static_cast<unsigned>(byte) & 15U];
    }
    return text;
}

RenderSettings unbiased() {
    RenderSettings settings;
    settings.samples_per_pixel = kBatch;
    settings.indirect_clamp = 0.0F;
    return settings;
}

} // namespace

References::References(const gpu::Device& device, LightFieldScene& scene, std::filesystem::path folder)
    : scene_(scene), folder_(std::move(folder)), renderer_(device, scene.gpu_scene()) {}

std::filesystem::path References::file_of(std::uint32_t frame, LatticePosition position) const {
    const std::string name = "frame" + std::to_string(frame) + "_row" + std::to_string(position.row_halves) + "_col" +
                             std::to_string(position.col_halves) + "_halves.exr";
    return folder_ / hex(scene_.scene().hash).substr(0, 16) /
           (std::to_string(scene_.size().width_px) + "x" + std::to_string(scene_.size().height_px)) / name;
}

nlohmann::ordered_json References::description() const {
    return {{"scene", hex(scene_.scene().hash)},
            {"spacing_m", scene_.grid().geometry.spacing_m.x},
            {"max_bounces", unbiased().max_bounces},
            {"seed", kSeed}};
}

std::uint32_t References::samples_of(std::uint32_t frame, LatticePosition position) const {
    std::ifstream stream(file_of(frame, position).replace_extension(".json"));
    const auto json = nlohmann::ordered_json::parse(stream, nullptr, false);
    const bool is_ours = json.is_object() && json.contains("of") && json["of"] == description() &&
                         json.contains("samples_per_pixel") && json["samples_per_pixel"].is_number_unsigned();
    return is_ours && std::filesystem::exists(file_of(frame, position)) ? json["samples_per_pixel"].get<std::uint32_t>()
                                                                        : 0;
}

void References::save(const std::filesystem::path& file, const Camera& camera) const {
    std::filesystem::create_directories(file.parent_path());
    // The description goes first and comes last: an image whose description is missing is made again.
    std::filesystem::path sidecar = file;
    sidecar.replace_extension(".json");
    std::filesystem::remove(sidecar);
    image::write_exr(file, {camera.width_px, camera.height_px, renderer_.image()});
    write_json(sidecar.string(), {{"of", description()}, {"samples_per_pixel", renderer_.samples_per_pixel()}});
}

std::optional<image::RgbF32> References::get(std::uint32_t frame, LatticePosition position, std::uint32_t samples,
                                             const Progress& progress) {
    const std::filesystem::path file = file_of(frame, position);
    const std::uint32_t existing = samples_of(frame, position);
    if (existing >= samples) {
        return image::read_rgb_f32(file, {});
    }
    const Camera camera = scene_.view(position);
    if (existing > 0) {
        renderer_.resume(camera, image::read_rgb_f32(file, {}).pixels, existing);
    } else {
        renderer_.start(camera);
    }
    auto saved = std::chrono::steady_clock::now();
    while (renderer_.samples_per_pixel() < samples) {
        renderer_.accumulate(unbiased(), seed_of(frame, position));
        const auto now = std::chrono::steady_clock::now();
        const bool goes_on = progress(renderer_.samples_per_pixel());
        if (!goes_on || now - saved > kSaveInterval || renderer_.samples_per_pixel() >= samples) {
            save(file, camera);
            saved = now;
        }
        if (!goes_on) {
            return std::nullopt;
        }
    }
    if (renderer_.invalid_sample_count() > 0) {
        throw std::runtime_error(file.string() + ": " + std::to_string(renderer_.invalid_sample_count()) +
                                 " invalid samples");
    }
    return image::RgbF32{camera.width_px, camera.height_px, renderer_.image()};
}

void make_references(LightFieldScene& scene, References& references, const std::vector<PictureId>& wanted,
                     std::uint32_t samples) {
    double missing = 0.0;
    for (const PictureId& picture : wanted) {
        const std::uint32_t lacking =
            samples - std::min(references.samples_of(picture.frame, picture.position), samples);
        missing += (lacking + kBatch - 1) / kBatch * kBatch;
    }
    if (missing == 0.0) {
        return;
    }
    Progress progress("references", missing);
    const InterruptGuard guard;
    for (const PictureId& picture : wanted) {
        std::uint32_t before = references.samples_of(picture.frame, picture.position);
        if (before >= samples) {
            continue;
        }
        scene.pose(picture.frame);
        const auto report = [&](std::uint32_t done) {
            progress.add(done - before);
            before = done;
            return !guard.is_interrupted();
        };
        if (!references.get(picture.frame, picture.position, samples, report)) {
            throw Interrupted{"the references made so far are kept, the same command goes on from there"};
        }
    }
}

} // namespace fieldcast::bench
