// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/gltf_builder.h"

#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;

/// A triangle with one material.
GltfBuilder with_material(const nlohmann::json& material) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.add("materials", material);
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    return builder;
}

TEST(GltfMaterials, ReadsMetallicRoughness) {
    const Scene scene =
        with_material(
            {{"name", "steel"},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
             {"alphaMode", "MASK"},
             {"alphaCutoff", 0.75},
             {"doubleSided", true}})
            .load();
    ASSERT_EQ(scene.materials.size(), 2U);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.name, "steel");
    EXPECT_EQ(material.base_colour_factor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(material.metallic_factor, 0.5F);
    EXPECT_EQ(material.roughness_factor, 0.25F);
    EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
    EXPECT_EQ(material.alpha_cutoff, 0.75F);
    EXPECT_TRUE(material.double_sided);
}

TEST(GltfMaterials, ReadsEmissionIorAndTransmission) {
    GltfBuilder builder = with_material(
        {{"emissiveFactor", {1, 0.5, 0}},
         {"alphaMode", "BLEND"},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
           {"KHR_materials_ior", {{"ior", 1.33}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.9}, {"transmissionTexture", {{"index", 0}}}}}}}});
    builder.add_texture();
    const Material material = builder.load().materials.at(0);
    EXPECT_EQ(material.emissive_factor, glm::vec3(8, 4, 0));
    EXPECT_EQ(material.ior, 1.33F);
    EXPECT_EQ(material.transmission_factor, 0.9F);
    EXPECT_EQ(material.transmission.texture, 0U);
    EXPECT_EQ(material.alpha_mode, AlphaMode::kBlend);
}

TEST(GltfMaterials, KeepsOnlyTexturesInUseAndReadsSamplers) {
    GltfBuilder builder = with_material({{"normalTexture", {{"index", 2}, {"scale", 0.5}, {"texCoord", 1}}},
                                         {"emissiveTexture", {{"index", 1}}},
                                         {"occlusionTexture", {{"index", 0}}}});
    for (int i = 0; i < 3; ++i) {
        builder.add_texture();
    }
    builder.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
    builder.json["textures"][2]["sampler"] = 0;
    const Scene scene = builder.load();
    ASSERT_EQ(scene.textures.size(), 2U);
    ASSERT_EQ(scene.images.size(), 2U);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.normal.uv_set, 1U);
    EXPECT_EQ(material.normal_scale, 0.5F);
    const Texture& normal = scene.textures.at(material.normal.texture);
    EXPECT_EQ(normal.wrap_u, Wrap::kClamp);
    EXPECT_EQ(normal.wrap_v, Wrap::kMirror);
    EXPECT_THAT(scene.images.at(normal.image).name, HasSubstr("image 2"));
    EXPECT_EQ(scene.images[0].width_px, 2U);
    EXPECT_EQ(scene.images[0].rgba.size(), 8U);
}

TEST(GltfMaterials, AppliesTextureTransforms) {
    const double quarter = 1.5707963267948966;
    GltfBuilder builder = with_material(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"extensions",
              {{"KHR_texture_transform",
                {{"offset", {0.25, 0.5}}, {"scale", {2, 3}}, {"rotation", quarter}, {"texCoord", 1}}}}}}}}}});
    builder.add_texture();
    const TextureUse use = builder.load().materials.at(0).base_colour;
    EXPECT_EQ(use.uv_set, 1U);
    const glm::vec3 corner(1, 0, 1);
    // (1, 0) · scale = (2, 0). A quarter turn counter-clockwise, seen with v downwards, maps it to (0, −2).
    EXPECT_NEAR(glm::dot(use.uv_matrix[0], corner), 0.25F, 1e-6F);
    EXPECT_NEAR(glm::dot(use.uv_matrix[1], corner), 0.5F - 2.0F, 1e-6F);
}

TEST(GltfMaterials, IgnoresTexturesItCannotUse) {
    GltfBuilder builder =
        with_material({{"emissiveTexture", {{"index", 0}, {"texCoord", 2}}}, {"normalTexture", {{"index", 1}}}});
    builder.add_texture();
    builder.add("textures", nlohmann::json::object());
    const Scene scene = builder.load();
    EXPECT_EQ(scene.materials[0].emissive.texture, kNone);
    EXPECT_EQ(scene.materials[0].normal.texture, kNone);
    EXPECT_EQ(scene.warnings.size(), 2U);
}

TEST(GltfMaterials, ReadsImagesFromFilesAndDataUris) {
    const TempFolder folder;
    folder.write("a folder/pic.png", small_png(3, 2));
    GltfBuilder builder = with_material({{"normalTexture", {{"index", 0}}}, {"emissiveTexture", {{"index", 1}}}});
    builder.add("images", {{"uri", "./a%20folder/pic.png"}});
    builder.add("images", {{"uri", "data:image/png;base64," + base64(small_png(1, 5))}});
    builder.add("textures", {{"source", 0}});
    builder.add("textures", {{"source", 1}});
    const Scene scene = load_scene(folder.write("test.gltf", builder.gltf()));
    ASSERT_EQ(scene.images.size(), 2U);
    EXPECT_EQ(scene.images[0].width_px, 3U);
    EXPECT_EQ(scene.images[1].height_px, 5U);
}

TEST(GltfMaterials, RefusesValuesOutOfRange) {
    EXPECT_THAT(refusal(with_material({{"alphaMode", "GLASS"}})), HasSubstr("material 0: unknown alphaMode 'GLASS'"));
    EXPECT_THAT(refusal(with_material({{"name", "m"}, {"emissiveFactor", {-1, 0, 0}}})),
                HasSubstr("test.gltf: material 0 'm': emissiveFactor"));
    EXPECT_THAT(refusal(with_material({{"emissiveFactor", {0, 1e39, 0}}})), HasSubstr("emissiveFactor"));
    EXPECT_THAT(refusal(with_material({{"pbrMetallicRoughness", {{"metallicFactor", 2}}}})),
                HasSubstr("metallicFactor"));
    EXPECT_THAT(refusal(with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1}}}}})),
                HasSubstr("baseColorFactor"));
    EXPECT_THAT(refusal(with_material({{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}})), HasSubstr("ior"));
    EXPECT_THAT(refusal(with_material({{"normalTexture", {{"index", 7}}}})), HasSubstr("texture 7 does not exist"));
    EXPECT_THAT(refusal(with_material({{"normalTexture", {{"scale", 1}}}})), HasSubstr("'index' property is missing"));
}

TEST(GltfMaterials, RefusesTooManyMaterials) {
    GltfBuilder builder = with_material(nlohmann::json::object());
    for (std::uint32_t i = 1; i + 1 < kMaxMaterials; ++i) {
        builder.add("materials", nlohmann::json::object());
    }
    EXPECT_EQ(builder.load().materials.size(), kMaxMaterials);
    builder.add("materials", nlohmann::json::object());
    EXPECT_THAT(refusal(builder), HasSubstr("materials: 4096 exceed the limit"));
}

TEST(GltfMaterials, RefusesImagesOverTheLimits) {
    GltfBuilder builder = with_material({{"normalTexture", {{"index", 0}}}, {"emissiveTexture", {{"index", 1}}}});
    builder.add_texture();
    builder.add_texture();
    LoadOptions options;
    options.limits.max_image_pixels = 1;
    EXPECT_THAT(refusal(builder, options), HasSubstr("image 0"));
    options.limits.max_image_pixels = 2;
    options.limits.max_total_image_pixels = 3;
    EXPECT_THAT(refusal(builder, options), HasSubstr("all images together exceed 3 pixels"));
}

} // namespace
} // namespace fieldcast::scene
