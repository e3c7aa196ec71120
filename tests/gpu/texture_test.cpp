// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/command_recorder.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/sample_texture.spv.h"

#include <cmath>
#include <glm/glm.hpp>

namespace fieldcast::gpu {
namespace {

using TextureTest = GpuTest;

// Filter weights have at least 8 bits and so has the storage of a level: a level or two of 256, in linear light.
constexpr float kTolerance = 0.01F;

using Layer = std::vector<std::uint8_t>;

Texture make_texture(const Device& device, const TextureDesc& desc, const std::vector<Layer>& layers) {
    std::vector<std::span<const std::byte>> spans;
    for (const auto& layer : layers) {
        spans.push_back(std::as_bytes(std::span(layer)));
    }
    return {device, desc, spans};
}

Layer grey(std::uint32_t texels, std::uint8_t value) {
    return Layer(std::size_t{texels} * 4, value);
}

/// Columns of black and white in turn.
Layer stripes(std::uint32_t side) {
    Layer layer;
    for (std::uint32_t texel = 0; texel < side * side; ++texel) {
        layer.insert(layer.end(), 4, texel % 2 == 0 ? std::uint8_t{0} : std::uint8_t{255});
    }
    return layer;
}

std::vector<float> sample_red(const Device& device, const Texture& texture, const std::vector<glm::vec4>& places) {
    const BindingLayout layout(device, {{0, BindingType::kTexture}});
    BindingSet set(device, layout);
    set.set(0, texture);
    const Kernel kernel(device, {"sample_texture", sample_texture_spv}, {{&layout}, 16});
    const auto input = make_buffer<glm::vec4>(device, places);
    const Buffer output(device, places.size() * sizeof(glm::vec4));
    const std::array<std::uint64_t, 2> push = {input.address(), output.address()};
    CommandRecorder recorder(device);
    recorder.dispatch(kernel, {&set}, push, {static_cast<std::uint32_t>(places.size())});
    recorder.submit();
    std::vector<float> red;
    for (const auto& colour : read_buffer_as<glm::vec4>(device, output, places.size())) {
        red.push_back(colour.r);
    }
    return red;
}

TEST_F(TextureTest, LayerIsACoordinate) {
    const auto texture = make_texture(device(), {4, 4, 3}, {grey(16, 0), grey(16, 102), grey(16, 255)});
    const auto red = sample_red(device(), texture, {{0.3F, 0.3F, 0, 0}, {0.3F, 0.3F, 1, 0}, {0.3F, 0.3F, 2, 2}});
    EXPECT_THAT(red, testing::Pointwise(testing::FloatNear(kTolerance), {0.0F, 0.4F, 1.0F}));
}

TEST_F(TextureTest, FiltersLinearlyAndRepeats) {
    const auto texture = make_texture(device(), {4, 4}, {stripes(4)});
    // Texel centres of columns 0 and 1, half way between, and one period further on.
    const auto red = sample_red(
        device(), texture,
        {{0.125F, 0.5F, 0, 0}, {0.375F, 0.5F, 0, 0}, {0.25F, 0.5F, 0, 0}, {1.375F, -0.5F, 0, 0}, {0.0F, 0.5F, 0, 0}});
    EXPECT_THAT(red, testing::Pointwise(testing::FloatNear(kTolerance), {0.0F, 1.0F, 0.5F, 1.0F, 0.5F}));
}

TEST_F(TextureTest, SrgbIsDecodedBeforeFiltering) {
    const TextureDesc desc{4, 4, 1, VK_FORMAT_R8G8B8A8_SRGB, true};
    const auto plain = make_texture(device(), desc, {grey(16, 128)});
    const float linear = std::pow((128.0F / 255.0F + 0.055F) / 1.055F, 2.4F);
    EXPECT_THAT(sample_red(device(), plain, {{0.3F, 0.3F, 0, 0}, {0.3F, 0.3F, 0, 2}}),
                testing::Each(testing::FloatNear(linear, kTolerance)));
    const auto striped = make_texture(device(), desc, {stripes(4)});
    EXPECT_NEAR(sample_red(device(), striped, {{0.25F, 0.5F, 0, 0}}).front(), 0.5F, kTolerance);
}

TEST_F(TextureTest, MipsAverageLinearLight) {
    for (const auto format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB}) {
        const auto texture = make_texture(device(), {8, 8, 2, format, true}, {stripes(8), grey(64, 255)});
        const auto red = sample_red(device(), texture,
                                    {{0.3F, 0.3F, 0, 1}, {0.3F, 0.3F, 0, 3}, {0.3F, 0.3F, 0, 9}, {0.3F, 0.3F, 1, 2}});
        EXPECT_THAT(red, testing::Pointwise(testing::FloatNear(kTolerance), {0.5F, 0.5F, 0.5F, 1.0F}));
    }
}

TEST_F(TextureTest, WithoutMipsTheLevelIsIgnored) {
    const auto texture = make_texture(device(), {4, 4, 1, VK_FORMAT_R8G8B8A8_UNORM, false}, {stripes(4)});
    EXPECT_NEAR(sample_red(device(), texture, {{0.375F, 0.5F, 0, 2}}).front(), 1.0F, kTolerance);
}

TEST_F(TextureTest, SidesNeedNotBeEqual) {
    const auto texture = make_texture(device(), {8, 2}, {grey(16, 51)});
    EXPECT_NEAR(sample_red(device(), texture, {{0.5F, 0.5F, 0, 3}}).front(), 0.2F, kTolerance);
}

TEST_F(TextureTest, RefusesLayersOfAnotherSize) {
    EXPECT_THROW(make_texture(device(), {4, 4}, {grey(15, 0)}), std::logic_error);
    EXPECT_THROW(make_texture(device(), {4, 4, 2}, {grey(16, 0)}), std::logic_error);
}

} // namespace
} // namespace fieldcast::gpu
