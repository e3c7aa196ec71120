// SPDX-License-Identifier: Apache-2.0
// Normals in the planes of a source, and textures in emission.
#include "core/image/packing.h"
#include "core/image/transfer.h"
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace fieldcast::render {
namespace {

class SurfaceTest : public RenderTest {
protected:
    /// Shading normals in a camera's pixels; zero in pixels without surface.
    std::vector<glm::vec3> normals(const scene::Scene& scene, const Camera& camera) const {
        const scene::GpuScene gpu_scene(device(), scene, traversal());
        FrameHeader header = plain_header(camera, 1);
        SourcePlanes planes(device());
        planes.resize(header);
        SurfacePlanesRenderer(device(), gpu_scene).render(planes);
        const SourceFrame frame = planes.download(kSourceSemantics);
        std::vector<glm::vec3> result = image::unpack_plane(*frame.find(PlaneSemantic::kNormal));
        const std::vector<glm::vec3> depth = image::unpack_plane(*frame.find(PlaneSemantic::kDepth));
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] = std::isfinite(depth[i].x) ? result[i] : glm::vec3(0.0F);
        }
        return result;
    }
};

TEST_F(SurfaceTest, NormalsOfScaledAndMirroredInstancesAreThoseOfTheEllipsoid) {
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0F), 0.7F, glm::normalize(glm::vec3(1, 2, 3)));
    for (const glm::vec3& scale :
         {glm::vec3(1, 1, 1), glm::vec3(1.4F, 0.6F, 0.9F), glm::vec3(-1.4F, 0.6F, 0.9F), glm::vec3(-1, -1, -0.5F)}) {
        const glm::mat4 place = at({0.2F, -0.1F, 0}) * turn * glm::scale(glm::mat4(1.0F), scale);
        SceneBuilder builder;
        builder.add(sphere(1.0F, 128, Shading::kSmooth), builder.add_material(diffuse(glm::vec3(0.5F))), place);
        const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, 0.6F, 32, 32);
        const std::vector<glm::vec3> seen = normals(builder.scene(), camera);
        const glm::mat4 object_from_world = glm::inverse(place);
        std::size_t checked = 0;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const glm::vec2 pixel(static_cast<float>(i % 32) + 0.5F, static_cast<float>(i / 32) + 0.5F);
            const glm::vec3 origin(object_from_world * glm::vec4(0, 0, 5, 1));
            const glm::vec3 ray(object_from_world * glm::vec4(unproject(camera, pixel, 1.0F) - glm::vec3(0, 0, 5), 0));
            // |origin + t ray| = 1
            const float a = glm::dot(ray, ray);
            const float b = glm::dot(origin, ray);
            const float inside = b * b - a * (glm::dot(origin, origin) - 1.0F);
            if (inside < 0.05F * a) {
                continue; // no hit, or a silhouette, where normals are bent towards the viewer
            }
            const glm::vec3 p = origin + ray * ((-b - std::sqrt(inside)) / a);
            const glm::vec3 expected = glm::normalize(glm::vec3(glm::transpose(object_from_world) * glm::vec4(p, 0)));
            // 128 slices are 2.8° wide. Interpolated normals and the faces' positions differ from the ellipsoid's by
            // much less than half of that, so 1° is enough.
            EXPECT_GT(glm::dot(seen[i], expected), std::cos(glm::radians(1.0F))) << i << " scale " << scale.x;
            ++checked;
        }
        EXPECT_GT(checked, 100U);
    }
}

/// Texture mapping and transform of a rectangle.
struct Mapping {
    bool mirrored_u = false;
    bool mirrored_v = false;
    bool has_tangents = false;
    bool mirrored_instance = false;
    bool second_set = false; ///< uses the second set of coordinates; the other one is constant
};

TEST_F(SurfaceTest, GreenOfANormalMapIsUpInTheImage) {
    // The map's only texel leans right and, more, up, as seen in the image: (0.36, 0.48, 0.8).
    const std::vector<std::uint8_t> texel{173, 189, 230, 255};
    const glm::vec3 lean = glm::normalize(glm::vec3(173, 189, 230) / 127.5F - 1.0F);
    for (int bits = 0; bits < 32; ++bits) {
        const Mapping mapping{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0};
        SceneBuilder builder;
        scene::Material material = diffuse(glm::vec3(0.5F));
        material.normal.texture = builder.add_texture(1, texel);
        scene::Mesh mesh = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        for (glm::vec2& uv : mesh.uv0) {
            uv = {mapping.mirrored_u ? 1.0F - uv.x : uv.x, mapping.mirrored_v ? 1.0F - uv.y : uv.y};
        }
        if (mapping.second_set) {
            mesh.uv1 = mesh.uv0;
            mesh.uv0.assign(4, glm::vec2(0.5F));
            material.normal.uv_set = 1;
        }
        const float u_sign = mapping.mirrored_u ? -1.0F : 1.0F;  // world x per u
        const float up_sign = mapping.mirrored_v ? -1.0F : 1.0F; // world y per −v
        if (mapping.has_tangents) { // as from MikkTSpace: bitangent = w · n × t is upwards in the image
            mesh.tangents.assign(4, glm::vec4(u_sign, 0, 0, u_sign * up_sign));
        }
        const float x_sign = mapping.mirrored_instance ? -1.0F : 1.0F;
        builder.add(mesh, builder.add_material(material), glm::scale(glm::mat4(1.0F), glm::vec3(x_sign, 1, 1)));
        const glm::vec3 expected(x_sign * u_sign * lean.x, up_sign * lean.y, lean.z);
        const glm::vec3 seen = normals(builder.scene(), look_at({0, 0, 3}, {0, 0, 0}, 0.2F, 3, 3))[4];
        // Octahedral encoding errs by 0.004°.
        EXPECT_GT(glm::dot(seen, expected), std::cos(glm::radians(0.02F)))
            << "case " << bits << ": " << seen.x << " " << seen.y << " " << seen.z;
    }
}

TEST_F(SurfaceTest, NormalScaleFlattensTheMap) {
    SceneBuilder builder;
    scene::Material material = diffuse(glm::vec3(0.5F));
    material.normal.texture = builder.add_texture(1, {173, 189, 230, 255});
    material.normal_scale = 0.5F;
    builder.add(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), builder.add_material(material));
    const glm::vec3 texel = glm::vec3(173, 189, 230) / 127.5F - 1.0F;
    const glm::vec3 expected = glm::normalize(texel * glm::vec3(0.5F, 0.5F, 1.0F));
    const glm::vec3 seen = normals(builder.scene(), look_at({0, 0, 3}, {0, 0, 0}, 0.2F, 3, 3))[4];
    EXPECT_GT(glm::dot(seen, expected), std::cos(glm::radians(0.02F)));
}

TEST_F(SurfaceTest, NormalsNeverFaceAwayFromTheViewer) {
    // A steep normal map is seen at a grazing angle.
    SceneBuilder builder;
    scene::Material material = diffuse(glm::vec3(0.5F));
    material.normal.texture = builder.add_texture(1, {128, 20, 160, 255}); // leans down, away from the viewer
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, 5}), builder.add_material(material));
    const Camera camera = look_at({0, -0.5F, 4}, {0, 0, 0}, 0.5F, 8, 8);
    std::size_t checked = 0;
    const std::vector<glm::vec3> seen = normals(builder.scene(), camera);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const glm::vec2 pixel(static_cast<float>(i % 8) + 0.5F, static_cast<float>(i / 8) + 0.5F);
        const glm::vec3 ray = glm::normalize(unproject(camera, pixel, 1.0F) - glm::vec3(0, -0.5F, 4));
        if (glm::length(seen[i]) > 0.5F) {
            EXPECT_LT(glm::dot(seen[i], ray), 0.0F) << i;
            EXPECT_LT(glm::reflect(ray, seen[i]).y, 1e-3F)
                << i; // reflected away from the surface, which is seen from below
            ++checked;
        }
    }
    EXPECT_GT(checked, 20U);
}

/// 8×8 texels with distinct colours.
std::vector<std::uint8_t> test_card() {
    std::vector<std::uint8_t> rgba;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const bool bright = (i + i / 8) % 2 == 0;
        rgba.insert(rgba.end(), {static_cast<std::uint8_t>(bright ? 250 : 20), static_cast<std::uint8_t>(i * 4),
                                 static_cast<std::uint8_t>(255 - i * 3), 255});
    }
    return rgba;
}

std::int32_t wrapped_texel(std::int32_t i, scene::Wrap wrap) {
    switch (wrap) {
    case scene::Wrap::kRepeat:
        return ((i % 8) + 8) % 8;
    case scene::Wrap::kMirror:
        return std::min(((i % 16) + 16) % 16, 15 - ((i % 16) + 16) % 16);
    case scene::Wrap::kClamp:
        return std::clamp(i, 0, 7);
    }
    return 0;
}

/// Bilinear lookup as glTF defines it, in linear light.
glm::dvec3 look_up(const std::vector<std::uint8_t>& rgba, glm::dvec2 uv, scene::Wrap wrap_u, scene::Wrap wrap_v) {
    const glm::dvec2 at = uv * 8.0 - 0.5;
    const glm::dvec2 low = glm::floor(at);
    const glm::dvec2 f = at - low;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 4; ++i) {
        const int dx = i % 2;
        const int dy = i / 2;
        const auto x = static_cast<std::size_t>(wrapped_texel(static_cast<std::int32_t>(low.x) + dx, wrap_u));
        const auto y = static_cast<std::size_t>(wrapped_texel(static_cast<std::int32_t>(low.y) + dy, wrap_v));
        const double weight = (dx == 1 ? f.x : 1.0 - f.x) * (dy == 1 ? f.y : 1.0 - f.y);
        for (int c = 0; c < 3; ++c) {
            sum[c] += weight * static_cast<double>(image::linear_from_srgb(
                                   static_cast<float>(rgba[(y * 8 + x) * 4 + static_cast<std::size_t>(c)]) / 255.0F));
        }
    }
    return sum;
}

TEST_F(SurfaceTest, TexturesWrapAndTransformAsInGltf) {
    constexpr std::uint32_t kSize = 96; // pixels over 3 repetitions of 8 texels: always magnified, so mip level 0
    const std::vector<std::uint8_t> card = test_card();
    struct Case {
        scene::Wrap u, v;
        std::array<glm::vec3, 2> matrix;
    };
    const std::array<glm::vec3, 2> identity{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
    // KHR_texture_transform: offset (0.3, -0.2), rotation 0.5, scale (0.7, 0.9): uv' = T · R · S · uv.
    const float c = std::cos(0.5F);
    const float s = std::sin(0.5F);
    const std::array<glm::vec3, 2> turned{glm::vec3(0.7F * c, 0.9F * s, 0.3F), glm::vec3(-0.7F * s, 0.9F * c, -0.2F)};
    using enum scene::Wrap;
    for (const Case& test : {Case{kRepeat, kRepeat, identity}, Case{kMirror, kClamp, identity},
                             Case{kClamp, kMirror, identity}, Case{kRepeat, kMirror, turned}}) {
        SceneBuilder builder;
        scene::Material material = emitter(glm::vec3(1.0F));
        material.emissive.texture = builder.add_texture(8, card);
        material.emissive.uv_matrix = test.matrix;
        builder.scene().textures.back().wrap_u = test.u;
        builder.scene().textures.back().wrap_v = test.v;
        scene::Mesh mesh = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        for (glm::vec2& uv : mesh.uv0) {
            uv = uv * 3.0F - 1.0F;
        }
        builder.add(mesh, builder.add_material(material));
        const Camera camera =
            look_at({0, 0, 4}, {0, 0, 0}, 2.0F * std::atan(0.25F), kSize, kSize); // shows exactly the rectangle
        const Estimate image = path_trace(builder.scene(), camera, {.samples = 1, .renders = 1, .max_bounces = 1});
        std::size_t wrong = 0;
        for (std::uint32_t y = 0; y < kSize; ++y) {
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const glm::vec3 uv((static_cast<float>(x) + 0.5F) / kSize * 3.0F - 1.0F,
                                   (static_cast<float>(y) + 0.5F) / kSize * 3.0F - 1.0F, 1.0F);
                const glm::dvec2 moved(glm::dot(test.matrix[0], uv), glm::dot(test.matrix[1], uv));
                const glm::dvec3 error = glm::abs(image.mean[image.index(x, y)] - look_up(card, moved, test.u, test.v));
                // Texture units place samples to 1/256 texel and may filter 8-bit values: 2/255 of the full range.
                wrong += std::max({error.x, error.y, error.z}) > 0.008 ? 1 : 0;
            }
        }
        EXPECT_EQ(wrong, 0U) << "wrap " << static_cast<int>(test.u) << " " << static_cast<int>(test.v);
    }
}

} // namespace
} // namespace fieldcast::render
