// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_file.h"
#include "tests/scene/gltf_builder.h"

#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;

TEST(Environment, IsAConstantSkyByDefault) {
    GltfBuilder builder;
    builder.add_triangle();
    const Environment environment = builder.load().environment;
    EXPECT_EQ(environment.constant, glm::vec3(0.5F, 0.7F, 1.0F));
    EXPECT_TRUE(environment.pixels.empty());
}

TEST(Environment, IsTheStudioWhereNothingGivesLight) {
    const LoadOptions options{.environment = {}, .surroundings = Surroundings::kStudioIfUnlit, .limits = {}};
    GltfBuilder unlit;
    unlit.add_triangle();
    const Scene scene = unlit.load(options);
    EXPECT_TRUE(scene.has_studio);
    ASSERT_FALSE(scene.environment.pixels.empty());
    const auto [darkest, brightest] = std::ranges::minmax(scene.environment.pixels, {}, &glm::vec3::x);
    EXPECT_GT(darkest.x, 0.0F) << "mirrors must not show black";
    EXPECT_GT(brightest.x, 20.0F * darkest.x) << "the studio must have lights";
    GltfBuilder glowing;
    glowing.add_triangle();
    glowing.json["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    EXPECT_FALSE(glowing.load(options).has_studio);
    EXPECT_FALSE(glowing.load(options).environment.constant == glm::vec3(0.0F));
}

TEST(Environment, ReadsAnImageFromAnyFolder) {
    const TempFolder folder;
    image::write_exr(folder.path() / "sky.exr", image::RgbF32{2, 1, {glm::vec3(0.25F), glm::vec3(900, 0, 1)}});
    GltfBuilder builder;
    builder.add_triangle();
    LoadOptions options;
    options.environment = folder.path() / "sky.exr";
    const Environment environment = builder.load(options).environment;
    EXPECT_EQ(environment.width_px, 2U);
    EXPECT_EQ(environment.height_px, 1U);
    ASSERT_EQ(environment.pixels.size(), 2U);
    EXPECT_EQ(environment.pixels[1], glm::vec3(900, 0, 1));
}

TEST(Environment, RefusesMissingHugeAndBrokenSkies) {
    const TempFolder folder;
    GltfBuilder builder;
    builder.add_triangle();
    LoadOptions options;
    options.environment = folder.path() / "none.hdr";
    EXPECT_THAT(refusal(builder, options), HasSubstr("environment: cannot open"));
    options.environment = folder.write("broken.hdr", std::string("#?RADIANCE\nFORMAT"));
    EXPECT_THAT(refusal(builder, options), HasSubstr("broken.hdr"));
    image::write_exr(folder.path() / "sky.exr", image::RgbF32{2, 1, {glm::vec3(1), glm::vec3(1)}});
    options.environment = folder.path() / "sky.exr";
    options.limits.max_image_pixels = 1;
    EXPECT_THAT(refusal(builder, options), HasSubstr("sky.exr"));
    LoadOptions sky;
    sky.sky = {0, -1, 0};
    EXPECT_THAT(refusal(builder, sky), HasSubstr("sky: radiance must be finite and not negative"));
    sky.sky = {NAN, 0, 0};
    EXPECT_THAT(refusal(builder, sky), HasSubstr("sky: radiance must be finite and not negative"));
}

} // namespace
} // namespace fieldcast::scene
