// SPDX-License-Identifier: Apache-2.0
#include "core/scene/ggx_albedo.h"

#include "shaders/shared/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fieldcast::scene {

namespace {

constexpr int kStrata = 32; // per dimension

float smith_term(float cos_theta, float alpha) {
    const float a2 = alpha * alpha;
    return std::sqrt(a2 + (1.0F - a2) * cos_theta * cos_theta);
}

glm::vec3 sample_visible_normal(const glm::vec3& view, float alpha, float u, float v) {
    const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * view.x, alpha * view.y, view.z));
    const float phi = 2.0F * std::numbers::pi_v<float> * u;
    const float z = (1.0F - v) * (1.0F + stretched.z) - stretched.z;
    const float s = std::sqrt(std::clamp(1.0F - z * z, 0.0F, 1.0F));
    const glm::vec3 h = glm::vec3(s * std::cos(phi), s * std::sin(phi), z) + stretched;
    return glm::normalize(glm::vec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-6F)));
}

glm::vec4 integrate(float cos_view, float roughness) {
    const float alpha = std::max(roughness * roughness, 1e-3F);
    const glm::vec3 view(std::sqrt(1.0F - cos_view * cos_view), 0.0F, cos_view);
    glm::dvec2 sum(0.0);
    for (int i = 0; i < kStrata * kStrata; ++i) {
        const float u = (static_cast<float>(i % kStrata) + 0.5F) / kStrata;
        const float v = (static_cast<float>(i / kStrata) + 0.5F) / kStrata;
        const glm::vec3 h = sample_visible_normal(view, alpha, u, v);
        const glm::vec3 light = glm::reflect(-view, h);
        if (light.z <= 0.0F) {
            continue;
        }
        // G2 / G1, height-correlated masking and shadowing
        const float lambda_view = smith_term(cos_view, alpha);
        const float lambda_light = smith_term(light.z, alpha);
        const float weight = light.z * (cos_view + lambda_view) / (light.z * lambda_view + cos_view * lambda_light);
        const float schlick = std::pow(std::clamp(1.0F - glm::dot(view, h), 0.0F, 1.0F), 5.0F);
        sum += glm::dvec2(weight * (1.0F - schlick), weight * schlick);
    }
    sum /= kStrata * kStrata;
    return {static_cast<float>(sum.x), static_cast<float>(sum.y), 0.0F, 0.0F};
}

} // namespace

std::vector<glm::vec4> make_ggx_albedo() {
    constexpr std::uint32_t size = shared::kGgxAlbedoSize;
    std::vector<glm::vec4> table;
    table.reserve(static_cast<std::size_t>(size) * size);
    for (std::uint32_t row = 0; row < size; ++row) {
        for (std::uint32_t col = 0; col < size; ++col) {
            const float cos_view = (static_cast<float>(col) + 0.5F) / size;
            const float roughness = static_cast<float>(row) / (size - 1);
            table.push_back(integrate(cos_view, roughness));
        }
    }
    return table;
}

} // namespace fieldcast::scene
