// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_file.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/image/atomic_file.h"
#include "core/image/image_header.h"
#include "core/image/light_image_header.h"
#include "core/image/webp.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace fieldcast::image {

namespace {

constexpr float kLargestHalf = 65504.0F;

std::string size_text(std::uint64_t width_px, std::uint64_t height_px) {
    return std::to_string(width_px) + "x" + std::to_string(height_px);
}

void check_limits(std::uint64_t width_px, std::uint64_t height_px, const std::string& name, const ImageLimits& limits) {
    if (width_px * height_px > limits.max_pixels) {
        throw UserError(name + ": image of " + size_text(width_px, height_px) + " pixels, at most " +
                        std::to_string(limits.max_pixels) + " pixels are accepted");
    }
}

/// Spreads 1 … 4 channels (grey, grey + alpha, RGB, RGBA) to RGBA.
Rgba8 spread_channels(const std::vector<std::uint8_t>& packed, std::uint32_t width_px, std::uint32_t height_px,
                      std::size_t channels) {
    Rgba8 image{width_px, height_px, {}};
    const std::size_t count = static_cast<std::size_t>(width_px) * height_px;
    const bool is_grey = channels < 3;
    const bool has_alpha = channels % 2 == 0;
    image.pixels.resize(count * 4);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* from = packed.data() + i * channels;
        std::uint8_t* to = image.pixels.data() + i * 4;
        to[0] = from[0];
        to[1] = from[is_grey ? 0 : 1];
        to[2] = from[is_grey ? 0 : 2];
        to[3] = has_alpha ? from[channels - 1] : std::uint8_t{255};
    }
    return image;
}

std::unique_ptr<OIIO::ImageInput> open_in_memory(const ImageHeader& header, OIIO::Filesystem::IOMemReader& source,
                                                 const std::string& name) {
    const char* const format = header.format == FileFormat::kPng ? "png" : "jpeg";
    auto input = OIIO::ImageInput::create(format);
    FC_ASSERT(input && input->supports("ioproxy"), "OpenImageIO decodes this format from memory");
    input->threads(1); // callers decode many images in parallel
    input->set_ioproxy(&source);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::ImageSpec spec;
    if (!input->open(std::string("memory.") + format, spec, config)) {
        throw UserError(name + ": " + input->geterror());
    }
    const bool is_as_claimed =
        spec.width == static_cast<int>(header.width_px) && spec.height == static_cast<int>(header.height_px);
    if (!is_as_claimed || spec.nchannels < 1 || spec.nchannels > 4) {
        throw UserError(name + ": contradictory image headers");
    }
    return input;
}

/// Encodes `pixels` in memory: tightly packed, with the channels of `spec` and of `type`, which may be another than the
/// file's.
std::vector<std::byte> encode(const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                              const void* pixels) {
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput target(encoded);
    const auto output = OIIO::ImageOutput::create(format);
    FC_ASSERT(output && output->supports("ioproxy"), "OpenImageIO encodes this format in memory");
    output->threads(1);
    output->set_ioproxy(&target);
    if (!output->open(std::string("memory.") + format, spec) || !output->write_image(type, pixels) ||
        !output->close()) {
        throw std::runtime_error(std::string("cannot encode ") + format + ": " + output->geterror());
    }
    const auto* begin = reinterpret_cast<const std::byte*>(encoded.data());
    return {begin, begin + encoded.size()};
}

OIIO::ImageSpec png_spec(std::uint32_t width_px, std::uint32_t height_px, int channels) {
    OIIO::ImageSpec spec(static_cast<int>(width_px), static_cast<int>(height_px), channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 4); // 84 ms, not 286 as with the default 6, for 5 % more bytes (720p photo)
    return spec;
}

/// First of the consecutive channels R, G, B (OpenImageIO sorts them so) of the first part.
int first_rgb_channel(const OIIO::ImageSpec& spec, const std::string& name) {
    const int red = spec.channelindex("R");
    if (red < 0 || spec.channelindex("G") != red + 1 || spec.channelindex("B") != red + 2) {
        throw UserError(name + ": no channels R, G and B");
    }
    return red;
}

/// Which of our formats `file` is in. Its header was checked.
LightFormat light_format(const std::filesystem::path& file, const ImageLimits& limits) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    const std::uintmax_t file_bytes = std::filesystem::file_size(file, error);
    if (!stream || error) {
        throw UserError(file.string() + ": cannot be read");
    }
    std::string beginning(kLightHeaderBytes, '\0');
    stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    beginning.resize(static_cast<std::size_t>(stream.gcount()));
    const auto format = read_light_image_header(std::as_bytes(std::span(beginning)), file_bytes, limits.max_pixels);
    return format ? *format : throw UserError(file.string() + ": " + format.error().message);
}

std::unique_ptr<OIIO::ImageInput> open_light_image(const std::string& name, const ImageLimits& limits) {
    const char* const format = light_format(name, limits) == LightFormat::kOpenExr ? "openexr" : "hdr";
    auto input = OIIO::ImageInput::create(format);
    FC_ASSERT(input, "OpenImageIO reads this format");
    input->threads(1);
    OIIO::ImageSpec spec;
    if (!input->open(name, spec)) {
        throw UserError(name + ": " + input->geterror());
    }
    if (spec.width < 1 || spec.height < 1 || spec.deep) {
        throw UserError(name + ": an image without size, or a deep one");
    }
    check_limits(static_cast<std::uint64_t>(spec.width), static_cast<std::uint64_t>(spec.height), name, limits);
    return input;
}

/// Refuses what would spread through every estimate, clamps what a half could not hold. Returns whether it clamped.
bool make_usable(float& value, const std::string& name, std::size_t pixel, std::uint32_t width_px) {
    if (std::isnan(value) || value < 0.0F) {
        throw UserError(name + ": pixel (" + std::to_string(pixel % width_px) + ", " +
                        std::to_string(pixel / width_px) + ") is " + (value < 0.0F ? "negative" : "not a number"));
    }
    if (std::isinf(value)) {
        value = kLargestHalf;
        return true;
    }
    return false;
}

void check_values(RgbF32& image, const std::string& name) {
    std::size_t clamped = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            clamped += make_usable(image.pixels[i][channel], name, i, image.width_px) ? 1 : 0;
        }
    }
    if (clamped > 0) {
        log::warn("infinite values clamped", {{"file", name}, {"values", clamped}, {"to", kLargestHalf}});
    }
}

} // namespace

Rgba8 decode_rgba8(std::span<const std::byte> bytes, const std::string& name, const ImageLimits& limits) {
    const Decoded<ImageHeader> header = read_image_header(bytes);
    if (!header) {
        throw UserError(name + ": " + header.error().message);
    }
    check_limits(header->width_px, header->height_px, name, limits);
    if (header->format == FileFormat::kWebp) {
        Decoded<Rgba8> image = decode_webp(bytes, *header);
        return image ? std::move(*image) : throw UserError(name + ": " + image.error().message);
    }
    OIIO::Filesystem::IOMemReader source(const_cast<std::byte*>(bytes.data()), bytes.size()); // only read
    const auto input = open_in_memory(*header, source, name);
    const auto channels = static_cast<std::size_t>(input->spec().nchannels);
    std::vector<std::uint8_t> packed(static_cast<std::size_t>(header->width_px) * header->height_px * channels);
    if (!input->read_image(0, 0, 0, input->spec().nchannels, OIIO::TypeDesc::UINT8, packed.data())) {
        throw UserError(name + ": " + input->geterror());
    }
    return spread_channels(packed, header->width_px, header->height_px, channels);
}

RgbF32 read_rgb_f32(const std::filesystem::path& file, const ImageLimits& limits) {
    const std::string name = file.string();
    const auto input = open_light_image(name, limits);
    const OIIO::ImageSpec spec = input->spec();
    const bool is_grey = spec.nchannels == 1;
    const int first = is_grey ? 0 : first_rgb_channel(spec, name);
    const int end = is_grey ? 1 : first + 3;
    RgbF32 image{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}};
    image.pixels.resize(static_cast<std::size_t>(image.width_px) * image.height_px);
    if (!input->read_image(0, 0, first, end, OIIO::TypeDesc::FLOAT, image.pixels.data(), sizeof(glm::vec3))) {
        throw UserError(name + ": " + input->geterror());
    }
    if (is_grey) {
        std::ranges::for_each(image.pixels, [](glm::vec3& pixel) { pixel = glm::vec3(pixel.x); });
    }
    check_values(image, name);
    return image;
}

std::vector<std::byte> encode_png(const Plane& rgb) {
    FC_ASSERT(rgb.format == PlaneFormat::kRgb8, "only kRgb8 planes are PNG images");
    FC_ASSERT(rgb.bytes.size() == plane_bytes(rgb.format, rgb.width_px, rgb.height_px), "plane has all its pixels");
    return encode("png", png_spec(rgb.width_px, rgb.height_px, 3), OIIO::TypeDesc::UINT8, rgb.bytes.data());
}

std::vector<std::byte> encode_png(const Rgba8& rgba) {
    FC_ASSERT(rgba.pixels.size() == 4ULL * rgba.width_px * rgba.height_px, "image has all its pixels");
    return encode("png", png_spec(rgba.width_px, rgba.height_px, 4), OIIO::TypeDesc::UINT8, rgba.pixels.data());
}

void write_png(const std::filesystem::path& file, const Plane& rgb) {
    write_file_atomically(file, encode_png(rgb));
}

void write_png(const std::filesystem::path& file, const Rgba8& rgba) {
    write_file_atomically(file, encode_png(rgba));
}

void write_exr(const std::filesystem::path& file, const RgbF32& rgb, ExrPrecision precision) {
    FC_ASSERT(rgb.pixels.size() == std::size_t{rgb.width_px} * rgb.height_px, "image has all its pixels");
    const auto stored = precision == ExrPrecision::kHalf ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
    OIIO::ImageSpec spec(static_cast<int>(rgb.width_px), static_cast<int>(rgb.height_px), 3, stored);
    spec.attribute("compression", "zip");
    write_file_atomically(file, encode("openexr", spec, OIIO::TypeDesc::FLOAT, rgb.pixels.data()));
}

} // namespace fieldcast::image
