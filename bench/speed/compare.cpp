// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench compare`: the metrics of `quality` for two image files.
#include "bench/commands.h"
#include "bench/measure.h"
#include "core/base/error.h"
#include "core/image/metrics.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <optional>
#include <span>

namespace fieldcast::bench {

namespace {

struct CompareOptions {
    std::string image;
    std::string reference;
    std::string json;
    double exposure = 1.0;
};

/// The image of one file: linear values if the file has them, and display-referred values.
struct Picture {
    std::optional<image::RgbF32> linear;
    image::RgbF32 display;
};

Picture read_picture(const std::string& file, float exposure) {
    std::string extension = std::filesystem::path(file).extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr" || extension == ".hdr") {
        image::RgbF32 linear = image::read_rgb_f32(file, {});
        for (glm::vec3& pixel : linear.pixels) {
            pixel *= exposure;
        }
        return {linear, image::display_image(linear, 1.0F)};
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw UserError(file + ": cannot be read");
    }
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    const image::Rgba8 decoded = image::decode_rgba8(std::as_bytes(std::span(bytes)), file, {});
    image::RgbF32 display{decoded.width_px, decoded.height_px, {}};
    for (std::size_t i = 0; i < decoded.pixels.size(); i += 4) {
        const auto value = [&](std::size_t c) { return static_cast<float>(decoded.pixels[i + c]) / 255.0F; };
        display.pixels.emplace_back(value(0), value(1), value(2));
    }
    return {std::nullopt, display};
}

void run_compare(const CompareOptions& options) {
    const Picture image = read_picture(options.image, static_cast<float>(options.exposure));
    const Picture reference = read_picture(options.reference, static_cast<float>(options.exposure));
    const Size size{image.display.width_px, image.display.height_px};
    const Size expected{reference.display.width_px, reference.display.height_px};
    if (to_string(size) != to_string(expected)) {
        throw UserError(options.image + ": " + to_string(size) + " pixels, but " + options.reference + " has " +
                        to_string(expected));
    }
    if (std::min(size.width_px, size.height_px) < 11) {
        throw UserError(options.image + ": SSIM needs at least 11x11 pixels");
    }
    nlohmann::ordered_json json{{"rmse", image::rmse(image.display, reference.display)},
                                {"ssim", image::ssim(image.display, reference.display)},
                                {"psnr_db", image::psnr_db(image.display, reference.display)}};
    if (image.linear && reference.linear) {
        json["relative_mse"] = image::relative_mse(*image.linear, *reference.linear);
    }
    for (const auto& [name, value] : json.items()) {
        std::cout << std::left << std::setw(14) << name << std::setprecision(6) << value.get<double>() << '\n';
    }
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
}

} // namespace

void add_compare_command(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "RMSE, SSIM and PSNR of one image file against another.");
    command->add_option("image", options->image, "Image file: PNG, JPEG, WebP (display-referred), EXR or HDR (linear).")
        ->required();
    command->add_option("reference", options->reference, "Reference image of the same size.")->required();
    command->add_option("--exposure", options->exposure, "Exposure of linear files.")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->callback([options] { run_compare(*options); });
}

} // namespace fieldcast::bench
