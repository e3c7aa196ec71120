// SPDX-License-Identifier: Apache-2.0
#include "core/image/source_frame_exr.h"

#include "core/image/packing.h"
#include "tests/unit/image/test_image.h"

#include <OpenImageIO/imageio.h>
#include <cstring>
#include <gmock/gmock.h>
#include <limits>

namespace fieldcast::image {
namespace {

using testing::ElementsAre;

template <class T> Plane plane_of(PlaneSemantic semantic, PlaneFormat format, std::initializer_list<T> values) {
    Plane plane{semantic, format, 2, 1, {}};
    plane.bytes.resize(values.size() * sizeof(T));
    std::memcpy(plane.bytes.data(), values.begin(), plane.bytes.size());
    return plane;
}

SourceFrame two_pixel_frame() {
    SourceFrame frame;
    frame.header.frame_id = 0xFFFFFFFFFFFFFFFFU;
    frame.header.scene_time_ns = -5;
    frame.header.cut = true;
    frame.header.source = make_camera(glm::mat4(1.0F), 1.0F, 1, 1);
    frame.header.source.world_from_camera[3] = glm::vec4(1.0F, 2.0F, 3.0F, 1.0F);
    frame.header.guard_band.left_px = 1;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    frame.planes = {
        plane_of(PlaneSemantic::kDiffuse, PlaneFormat::kR11G11B10F,
                 {pack_r11g11b10f({0.1F, 2.0F, 300.0F}), pack_r11g11b10f({65024.0F, 1e-6F, 0.0F})}),
        plane_of(PlaneSemantic::kDepth, PlaneFormat::kF32, {1.2345678F, kInfinity}),
        plane_of(PlaneSemantic::kNormal, PlaneFormat::kOct2x16, {pack_oct2x16({0, 0, -1}), pack_oct2x16({0, 1, 0})}),
        plane_of<std::uint32_t>(PlaneSemantic::kId, PlaneFormat::kU32, {0xFFFFFFFFU, 5U << 12 | 7U}),
        plane_of<std::uint8_t>(PlaneSemantic::kMaterial, PlaneFormat::kRg8, {128, 255, 1, 0}),
    };
    return frame;
}

struct SourceFrameExr : testing::Test {
    SourceFrameExr() {
        write_exr(folder.path() / "frame.exr", frame);
        input = OIIO::ImageInput::open((folder.path() / "frame.exr").string());
    }
    std::vector<float> floats(int part) {
        std::vector<float> values(2 * static_cast<std::size_t>(input->spec(part).nchannels));
        input->read_image(part, 0, 0, input->spec(part).nchannels, OIIO::TypeDesc::FLOAT, values.data());
        return values;
    }

    test::TestFolder folder;
    SourceFrame frame = two_pixel_frame();
    std::unique_ptr<OIIO::ImageInput> input;
};

TEST_F(SourceFrameExr, WritesOnePartPerPlane) {
    ASSERT_TRUE(input);
    const std::vector<std::string> names{"diffuse", "depth", "normal", "id", "material"};
    for (int part = 0; part < 5; ++part) {
        EXPECT_EQ(input->spec(part).get_string_attribute("oiio:subimagename"), names[static_cast<std::size_t>(part)]);
        EXPECT_EQ(input->spec(part).width, 2);
    }
    EXPECT_FALSE(input->seek_subimage(5, 0));
    EXPECT_THAT(input->spec(0).channelnames, ElementsAre("R", "G", "B"));
    EXPECT_THAT(input->spec(1).channelnames, ElementsAre("Z"));
    EXPECT_EQ(input->spec(0).format, OIIO::TypeDesc::HALF);
    EXPECT_EQ(input->spec(3).format, OIIO::TypeDesc::UINT32);
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST_F(SourceFrameExr, LosesNoPrecision) {
    ASSERT_TRUE(input);
    const std::vector<glm::vec3> diffuse = unpack_plane(frame.planes[0]);
    EXPECT_THAT(floats(0), ElementsAre(diffuse[0].x, diffuse[0].y, diffuse[0].z, diffuse[1].x, diffuse[1].y, 0.0F));
    EXPECT_THAT(floats(1), ElementsAre(1.2345678F, std::numeric_limits<float>::infinity()));
    EXPECT_THAT(floats(2), ElementsAre(0.0F, 0.0F, -1.0F, 0.0F, 1.0F, 0.0F));
    std::vector<std::uint32_t> ids(2);
    ASSERT_TRUE(input->read_image(3, 0, 0, 1, OIIO::TypeDesc::UINT32, ids.data()));
    EXPECT_THAT(ids, ElementsAre(0xFFFFFFFFU, 5U << 12 | 7U));
    const std::vector<float> material = floats(4); // metallic, roughness: EXR sorts channels by name
    ASSERT_EQ(input->spec(4).channelindex("metallic"), 0);
    EXPECT_NEAR(material[0], 1.0F, 1e-6F);
    EXPECT_NEAR(material[1], 128.0F / 255.0F, 0.25F / 255.0F);
    EXPECT_NEAR(material[3], 1.0F / 255.0F, 0.25F / 255.0F);
}

TEST_F(SourceFrameExr, CarriesTheCamera) {
    ASSERT_TRUE(input);
    const OIIO::ImageSpec spec = input->spec(0);
    EXPECT_EQ(spec.get_string_attribute("fieldcast:frame_id"), "18446744073709551615");
    EXPECT_EQ(spec.get_string_attribute("fieldcast:scene_time_ns"), "-5");
    EXPECT_EQ(spec.get_int_attribute("fieldcast:cut"), 1);
    EXPECT_FLOAT_EQ(spec.get_float_attribute("fieldcast:fovy_rad"), 1.0F);
    EXPECT_EQ(spec.get_string_attribute("fieldcast:guard_band_px"), "1 0 0 0");
    const auto* matrix = spec.find_attribute("worldToCamera", OIIO::TypeMatrix);
    ASSERT_TRUE(matrix != nullptr);
    const auto* values = static_cast<const float*>(matrix->data());
    EXPECT_EQ(values[12], -1.0F);
    EXPECT_EQ(values[13], -2.0F);
    EXPECT_EQ(values[14], -3.0F);
}

} // namespace
} // namespace fieldcast::image
