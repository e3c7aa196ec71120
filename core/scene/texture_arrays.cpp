// SPDX-License-Identifier: Apache-2.0
#include "core/scene/texture_arrays.h"

#include "core/base/error.h"

#include <algorithm>
#include <bit>
#include <set>

namespace fieldcast::scene {

namespace {

constexpr std::uint32_t kClassesPerSpace = shared::kTextureArrays / 2;

std::uint32_t class_side(const Image& image) {
    return std::bit_ceil(std::max(image.width_px, image.height_px));
}

/// The images that materials read as colour (sRGB) or as data (linear). An image can be in both sets.
std::set<std::uint32_t> images_used(const Scene& scene, bool srgb) {
    std::set<std::uint32_t> used;
    const auto add = [&](const TextureUse& use) {
        if (use.texture != kNone) {
            used.insert(scene.textures[use.texture].image);
        }
    };
    for (const Material& material : scene.materials) {
        if (srgb) {
            add(material.base_colour);
            add(material.emissive);
        } else {
            add(material.metallic_roughness);
            add(material.normal);
            add(material.transmission);
        }
    }
    return used;
}

/// Resamples an image bilinearly to a square of `side` pixels; the image repeats at the border.
std::vector<std::byte> resampled(const Image& image, std::uint32_t side) {
    std::vector<std::byte> out(static_cast<std::size_t>(side) * side * 4);
    const auto channel = [&](std::uint32_t x, std::uint32_t y, std::uint32_t c) {
        return static_cast<float>(
            image.rgba[(static_cast<std::size_t>(y % image.height_px) * image.width_px + x % image.width_px) * 4 + c]);
    };
    for (std::uint32_t y = 0; y < side; ++y) {
        const float v =
            (static_cast<float>(y) + 0.5F) * static_cast<float>(image.height_px) / static_cast<float>(side) +
            static_cast<float>(image.height_px) - 0.5F;
        const auto y0 = static_cast<std::uint32_t>(v);
        const float fy = v - static_cast<float>(y0);
        for (std::uint32_t x = 0; x < side; ++x) {
            const float u =
                (static_cast<float>(x) + 0.5F) * static_cast<float>(image.width_px) / static_cast<float>(side) +
                static_cast<float>(image.width_px) - 0.5F;
            const auto x0 = static_cast<std::uint32_t>(u);
            const float fx = u - static_cast<float>(x0);
            for (std::uint32_t c = 0; c < 4; ++c) {
                const float top = channel(x0, y0, c) * (1.0F - fx) + channel(x0 + 1, y0, c) * fx;
                const float bottom = channel(x0, y0 + 1, c) * (1.0F - fx) + channel(x0 + 1, y0 + 1, c) * fx;
                out[(static_cast<std::size_t>(y) * side + x) * 4 + c] =
                    static_cast<std::byte>(top * (1.0F - fy) + bottom * fy + 0.5F);
            }
        }
    }
    return out;
}

} // namespace

TextureArrays::TextureArrays(const gpu::Device& device, const Scene& scene) : scene_(scene) {
    plan(scene, true);
    plan(scene, false);
    for (std::uint32_t array = 0; array < shared::kTextureArrays; ++array) {
        upload(device, scene, array);
    }
}

// Each of the largest sizes has its own class; the last class also takes all smaller images.
void TextureArrays::plan(const Scene& scene, bool srgb) {
    const std::set<std::uint32_t> used = images_used(scene, srgb);
    std::set<std::uint32_t, std::greater<>> sides;
    for (const std::uint32_t image : used) {
        sides.insert(class_side(scene.images[image]));
    }
    std::vector<std::uint32_t> classes(sides.begin(), sides.end());
    classes.resize(std::min<std::size_t>(classes.size(), kClassesPerSpace));
    places_[srgb].resize(scene.images.size());
    for (const std::uint32_t image : used) {
        const std::uint32_t side = class_side(scene.images[image]);
        std::uint32_t index = 0;
        while (index + 1 < classes.size() && classes[index] > side) {
            ++index;
        }
        const std::uint32_t array = index + (srgb ? 0 : kClassesPerSpace);
        sides_[array] = classes[index];
        places_[srgb][image] = {array, static_cast<std::uint32_t>(images_[array].size()), classes[index]};
        images_[array].push_back(image);
    }
}

void TextureArrays::upload(const gpu::Device& device, const Scene& scene, std::uint32_t array) {
    gpu::TextureDesc desc;
    desc.format = array < kClassesPerSpace ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    std::vector<std::vector<std::byte>> resized;
    std::vector<std::span<const std::byte>> layers;
    const std::vector<std::byte> white(4, std::byte{255});
    if (images_[array].empty()) {
        desc.mip_maps = false;
        layers.emplace_back(white);
        arrays_[array] = gpu::Texture(device, desc, layers);
        return;
    }
    const std::uint32_t side = sides_[array];
    if (side > device.info().max_image_side || images_[array].size() > device.info().max_image_layers) {
        throw UserError(scene.name + ": " + std::to_string(images_[array].size()) + " images of " +
                        std::to_string(side) + " pixels a side do not fit into one array of " + device.info().name +
                        " (at most " + std::to_string(device.info().max_image_layers) + " images of " +
                        std::to_string(device.info().max_image_side) + " pixels); use fewer or smaller textures");
    }
    resized.reserve(images_[array].size());
    for (const std::uint32_t index : images_[array]) {
        const Image& image = scene.images[index];
        if (image.width_px == side && image.height_px == side) {
            layers.push_back(std::as_bytes(std::span(image.rgba)));
        } else {
            layers.emplace_back(resized.emplace_back(resampled(image, side)));
        }
    }
    desc.width_px = side;
    desc.height_px = side;
    desc.layers = static_cast<std::uint32_t>(layers.size());
    arrays_[array] = gpu::Texture(device, desc, layers);
    used_mask_ |= 1U << array;
    device_bytes_ += static_cast<std::uint64_t>(side) * side * 4 * desc.layers * 4 / 3;
}

TexturePlace TextureArrays::place(std::uint32_t texture, bool srgb) const {
    return places_[srgb][scene_.textures[texture].image];
}

} // namespace fieldcast::scene
