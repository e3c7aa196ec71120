// SPDX-License-Identifier: Apache-2.0
// Frames of a device whose memory the host cannot map: the same bytes arrive through staging buffers.
#include "core/render/warp/warp_planes.h"
#include "tests/render/render_test.h"

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;
constexpr LatticeGeometry kGeometry{{0.06F, 0.06F}};

using Pictures = std::vector<std::vector<std::byte>>;

class UnmappedMemoryTest : public RenderTest {
protected:
    static FrameHeader header_of(std::uint32_t frame) {
        FrameHeader header = plain_header(room_camera(kWidth, kHeight), 1);
        header.cut = frame == 0;
        header.noise_frame = frame;
        header.settings.accumulate_views = frame > 0; // with the filter over views, too
        return header;
    }

    /// Views and planes of three frames. The number of views goes up and down, so that buffers that were grown are used
    /// in part.
    Pictures pictures_of(const gpu::Device& device) const {
        Stage s(device, area_lit_room(), traversal());
        WarpPlanesRenderer warp_planes(device, s.gpu_scene, s.grid);
        Pictures pictures;
        std::uint32_t frame = 0;
        for (const std::uint32_t side : {2U, 3U, 1U}) {
            const FrameHeader header = header_of(frame++);
            s.gpu_scene.pose(0, header.cut);
            const SourcePlanes& source = s.source.render(header);
            for (View& view : s.grid.render(source, grid_request(header.source, side, side, kGeometry)).views) {
                pictures.push_back(std::move(view.image.bytes));
            }
            SourceFrame planes = source.download(kSourceSemantics);
            warp_planes.render(source, {side, side, kGeometry}, true, planes);
            for (Plane& plane : planes.planes) {
                pictures.push_back(std::move(plane.bytes));
            }
        }
        EXPECT_EQ(s.source.invalid_sample_count() + s.grid.invalid_sample_count(), 0U);
        return pictures;
    }
};

TEST_F(UnmappedMemoryTest, FramesHaveTheSameBytes) {
    const Pictures mapped = pictures_of(device());
    const Pictures unmapped = pictures_of(unmapped_device());
    ASSERT_EQ(unmapped.size(), mapped.size());
    for (std::size_t i = 0; i < mapped.size(); ++i) {
        EXPECT_TRUE(unmapped[i] == mapped[i]) << "picture " << i;
    }
}

} // namespace
} // namespace fieldcast::render
