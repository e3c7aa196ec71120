// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/references.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kBatch = 16; // samples between reports of progress
constexpr std::array<std::uint32_t, 2> kSeeds{0x5EED, 0xC0FFEE5};
constexpr std::chrono::seconds kSaveInterval{30};

/// A different seed for each picture: equal noise would not average out in refocused images or appear as change over
/// time.
std::uint32_t seed_of(std::uint32_t frame, LatticePosition position, std::uint32_t half) {
    const ViewIndex index = view_index(position);
    return kSeeds[half] + 4096U * frame + static_cast<std::uint32_t>(64 * index.row + index.col);
}

/// Samples of each of the two halves, which have `samples` together.
constexpr std::uint32_t half_of(std::uint32_t samples) {
    return (samples + 2 * kBatch - 1) / (2 * kBatch) * kBatch;
}

image::RgbF32 weighted_mean(const image::RgbF32& first, float first_samples, const image::RgbF32& second,
                            float second_samples) {
    image::RgbF32 mean = first;
    const float share = second_samples / (first_samples + second_samples);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        mean.pixels[i] += share * (second.pixels[i] - mean.pixels[i]);
    }
    return mean;
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

References::References(const gpu::Device& device, LightFieldScene& scene, std::filesystem::path folder,
                       image::ExrPrecision precision)
    : scene_(scene), folder_(std::move(folder)), precision_(precision), renderer_(device, scene.gpu_scene()) {}

std::filesystem::path References::file_of(const Part& part) const {
    const std::string name = "frame" + std::to_string(part.frame) + "_row" + std::to_string(part.position.row_halves) +
                             "_col" + std::to_string(part.position.col_halves) + "_halves" +
                             (part.half == 1 ? "_second" : "") + ".exr";
    return folder_ / hex(scene_.scene().hash).substr(0, 16) /
           (std::to_string(scene_.size().width_px) + "x" + std::to_string(scene_.size().height_px)) / name;
}

nlohmann::ordered_json References::description(const Part& part) const {
    return {{"scene", hex(scene_.scene().hash)},
            {"spacing_m", scene_.grid().geometry.spacing_m.x},
            {"max_bounces", unbiased().max_bounces},
            {"seed", kSeeds[part.half]}};
}

/// Number of samples in the file of this part; 0 if there is none or it belongs to another scene or other settings.
std::uint32_t References::samples_of(const Part& part) const {
    const std::filesystem::path file = file_of(part);
    std::ifstream stream(std::filesystem::path(file).replace_extension(".json"));
    const auto json = nlohmann::ordered_json::parse(stream, nullptr, false);
    const bool is_ours = json.is_object() && json.contains("of") && json["of"] == description(part) &&
                         json.contains("samples_per_pixel") && json["samples_per_pixel"].is_number_unsigned();
    return is_ours && std::filesystem::exists(file) ? json["samples_per_pixel"].get<std::uint32_t>() : 0;
}

std::uint32_t References::lacking(std::uint32_t frame, LatticePosition position, std::uint32_t samples) const {
    std::uint32_t lacking = 0;
    for (const std::uint32_t half : {0U, 1U}) {
        lacking += half_of(samples) - std::min(samples_of({frame, position, half}), half_of(samples));
    }
    return lacking;
}

void References::save(const Part& part, const Camera& camera) const {
    const std::filesystem::path file = file_of(part);
    std::filesystem::create_directories(file.parent_path());
    // The description is removed first and written last: an image without a description is made again.
    std::filesystem::path sidecar = file;
    sidecar.replace_extension(".json");
    std::filesystem::remove(sidecar);
    image::write_exr(file, {camera.width_px, camera.height_px, renderer_.image()}, precision_);
    write_json(sidecar.string(), {{"of", description(part)}, {"samples_per_pixel", renderer_.samples_per_pixel()}});
}

/// Renders until the part has `samples`; false if `progress` stopped it.
bool References::add_samples(const Part& part, std::uint32_t samples, const Progress& progress) {
    const std::uint32_t existing = samples_of(part);
    if (existing >= samples) {
        return true;
    }
    const Camera camera = scene_.view(part.position);
    if (existing > 0) {
        renderer_.resume(camera, image::read_rgb_f32(file_of(part), {}).pixels, existing);
    } else {
        renderer_.start(camera);
    }
    auto saved = std::chrono::steady_clock::now();
    while (renderer_.samples_per_pixel() < samples) {
        renderer_.accumulate(unbiased(), seed_of(part.frame, part.position, part.half));
        const auto now = std::chrono::steady_clock::now();
        const bool goes_on = progress(renderer_.samples_per_pixel() - existing);
        if (!goes_on || now - saved > kSaveInterval || renderer_.samples_per_pixel() >= samples) {
            save(part, camera);
            saved = now;
        }
        if (!goes_on) {
            return false;
        }
    }
    if (renderer_.invalid_sample_count() > 0) {
        throw std::runtime_error(file_of(part).string() + ": " + std::to_string(renderer_.invalid_sample_count()) +
                                 " invalid samples");
    }
    return true;
}

std::optional<ReferencePicture> References::get(std::uint32_t frame, LatticePosition position, std::uint32_t samples,
                                                const Progress& progress) {
    const std::array<Part, 2> parts{Part{frame, position, 0}, Part{frame, position, 1}};
    std::uint32_t before = 0; // added to parts that are complete
    for (const Part& part : parts) {
        std::uint32_t added = 0;
        const auto report = [&](std::uint32_t done) {
            added = done;
            return progress(before + done);
        };
        if (!add_samples(part, half_of(samples), report)) {
            return std::nullopt;
        }
        before += added;
    }
    ReferencePicture picture;
    for (const Part& part : parts) {
        picture.halves[part.half] = image::read_rgb_f32(file_of(part), {});
    }
    picture.mean = weighted_mean(picture.halves[0], static_cast<float>(samples_of(parts[0])), picture.halves[1],
                                 static_cast<float>(samples_of(parts[1])));
    return picture;
}

void make_references(LightFieldScene& scene, References& references, const std::vector<PictureId>& wanted,
                     std::uint32_t samples) {
    double missing = 0.0;
    for (const PictureId& picture : wanted) {
        missing += references.lacking(picture.frame, picture.position, samples);
    }
    if (missing == 0.0) {
        return;
    }
    Progress progress("references", missing);
    const InterruptGuard guard;
    for (const PictureId& picture : wanted) {
        if (references.lacking(picture.frame, picture.position, samples) == 0) {
            continue;
        }
        scene.pose(picture.frame);
        std::uint32_t before = 0;
        const auto report = [&](std::uint32_t done) {
            progress.add(done - before);
            before = done;
            return !guard.is_interrupted();
        };
        if (!references.get(picture.frame, picture.position, samples, report)) {
            throw Interrupted{"the references made so far are kept; the same command continues from them"};
        }
    }
}

} // namespace fieldcast::bench
