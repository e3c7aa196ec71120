// SPDX-License-Identifier: Apache-2.0
#include "core/scene/studio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace fieldcast::scene {

namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 32;
constexpr float kPi = std::numbers::pi_v<float>;

/// A light whose radiance falls off around its direction.
struct Softbox {
    float azimuth_deg = 0.0F; ///< from +Z towards +X
    float elevation_deg = 0.0F;
    float radius_deg = 0.0F; ///< angle at which it has half of its radiance
    float radiance = 0.0F;
};

constexpr std::array kSoftboxes{Softbox{40.0F, 50.0F, 22.0F, 9.0F}, Softbox{-65.0F, 20.0F, 26.0F, 2.2F},
                                Softbox{170.0F, 35.0F, 18.0F, 4.0F}};

glm::vec3 direction_of(float azimuth_deg, float elevation_deg) {
    const float azimuth = azimuth_deg * kPi / 180.0F;
    const float elevation = elevation_deg * kPi / 180.0F;
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation)};
}

/// Radiance of walls, floor and ceiling, and of the lights on them.
float radiance_from(const glm::vec3& direction) {
    float radiance = 0.30F + 0.22F * direction.y; // the ceiling is lighter than the floor
    for (const Softbox& light : kSoftboxes) {
        const float cosine = glm::dot(direction, direction_of(light.azimuth_deg, light.elevation_deg));
        const float angle_deg = std::acos(std::clamp(cosine, -1.0F, 1.0F)) * 180.0F / kPi;
        radiance += light.radiance * std::exp2(-(angle_deg / light.radius_deg) * (angle_deg / light.radius_deg));
    }
    return radiance;
}

/// Direction of a pixel's centre: −Z at u = 0.5, +X at u = 0.75, +Y at v = 0.
glm::vec3 direction_at(std::uint32_t col, std::uint32_t row) {
    const float phi = 2.0F * kPi * ((static_cast<float>(col) + 0.5F) / kWidth - 0.5F);
    const float theta = kPi * (static_cast<float>(row) + 0.5F) / kHeight;
    return {std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
}

/// A grey pixel of a Radiance file: value · 2^(exponent - 136).
struct Grey {
    std::uint8_t value = 0;
    std::uint8_t exponent = 0;
};

Grey grey_at(std::uint32_t col, std::uint32_t row) {
    int exponent = 0;
    const float mantissa = std::frexp(radiance_from(direction_at(col, row)), &exponent);
    return {static_cast<std::uint8_t>(mantissa * 256.0F), static_cast<std::uint8_t>(exponent + 128)};
}

} // namespace

bool has_light(const Scene& scene) {
    return !scene.lights.empty() || std::ranges::any_of(scene.materials, [](const Material& material) {
        return glm::any(glm::greaterThan(material.emissive_factor, glm::vec3(0.0F)));
    });
}

std::vector<std::byte> studio_file() {
    const std::string head =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(kHeight) + " +X " + std::to_string(kWidth) + "\n";
    std::vector<std::byte> file(head.size());
    std::ranges::transform(head, file.begin(), [](char c) { return static_cast<std::byte>(c); });
    for (std::uint32_t row = 0; row < kHeight; ++row) {
        // Run-length encoded scanline, channel by channel, without runs. The flat form would be ambiguous.
        std::array<std::array<std::byte, kWidth>, 4> channels{};
        for (std::uint32_t col = 0; col < kWidth; ++col) {
            const Grey grey = grey_at(col, row);
            channels[0][col] = channels[1][col] = channels[2][col] = std::byte{grey.value};
            channels[3][col] = std::byte{grey.exponent};
        }
        for (const std::byte byte : {std::byte{2}, std::byte{2}, std::byte{0}, std::byte{kWidth}}) {
            file.push_back(byte);
        }
        for (const auto& channel : channels) {
            file.push_back(std::byte{kWidth}); // number of literal bytes
            file.insert(file.end(), channel.begin(), channel.end());
        }
    }
    return file;
}

Environment studio_environment() {
    Environment environment{.constant = glm::vec3(0.0F), .width_px = kWidth, .height_px = kHeight, .pixels = {}};
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const Grey grey = grey_at(i % kWidth, i / kWidth);
        environment.pixels.emplace_back(std::ldexp(static_cast<float>(grey.value), grey.exponent - 136));
    }
    return environment;
}

} // namespace fieldcast::scene
