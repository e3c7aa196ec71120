// SPDX-License-Identifier: Apache-2.0
#include "core/image/source_frame_exr.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"
#include "core/image/packing.h"

#include <OpenImageIO/imageio.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace fieldcast::image {

namespace {

/// Layout of a plane in the file. `type` is the stored type. Pixels are passed as `unpack_plane` returns them, and
/// their first `channels` components are written.
struct Layout {
    const char* part = "";
    std::vector<std::string> channels;
    OIIO::TypeDesc type = OIIO::TypeDesc::HALF;
};

Layout layout_of(PlaneSemantic semantic) {
    switch (semantic) {
    case PlaneSemantic::kDiffuse:
        return {"diffuse", {"R", "G", "B"}, OIIO::TypeDesc::HALF};
    case PlaneSemantic::kSpecular:
        return {"specular", {"R", "G", "B"}, OIIO::TypeDesc::HALF};
    case PlaneSemantic::kDepth:
        return {"depth", {"Z"}, OIIO::TypeDesc::FLOAT};
    case PlaneSemantic::kNormal:
        return {"normal", {"normal.X", "normal.Y", "normal.Z"}, OIIO::TypeDesc::FLOAT};
    case PlaneSemantic::kId:
        return {"id", {"id"}, OIIO::TypeDesc::UINT32};
    case PlaneSemantic::kMaterial:
        return {"material", {"roughness", "metallic"}, OIIO::TypeDesc::HALF};
    case PlaneSemantic::kColour:
        return {"colour", {"R", "G", "B"}, OIIO::TypeDesc::HALF};
    case PlaneSemantic::kInverseDepth:
        return {"inverse_depth", {"Y"}, OIIO::TypeDesc::FLOAT};
    case PlaneSemantic::kResidualColour:
        return {"residual_colour", {"R", "G", "B"}, OIIO::TypeDesc::HALF};
    case PlaneSemantic::kResidualInverseDepth:
        return {"residual_inverse_depth", {"Y"}, OIIO::TypeDesc::FLOAT};
    case PlaneSemantic::kTotalLight:
        return {"total_light", {"R", "G", "B"}, OIIO::TypeDesc::HALF};
    }
    FC_ASSERT(false, "plane semantic is known");
    return {};
}

void describe(OIIO::ImageSpec& spec, const FrameHeader& header) {
    const Camera camera = widened_source(header, 0);
    // OpenEXR multiplies row vectors, so its matrices are transposed, but glm stores columns: the 16 numbers are the
    // same.
    const glm::mat4 camera_from_world = glm::inverse(camera.world_from_camera);
    spec.attribute("worldtocamera", OIIO::TypeDesc::TypeMatrix, &camera_from_world[0][0]);
    spec.attribute("fieldcast:frame_id", std::to_string(header.frame_id));
    spec.attribute("fieldcast:scene_time_ns", std::to_string(header.scene_time_ns));
    spec.attribute("fieldcast:cut", header.cut ? 1 : 0);
    spec.attribute("fieldcast:seed", std::to_string(header.seed));
    spec.attribute("fieldcast:fovy_rad", vertical_fov(header.source));
    spec.attribute("fieldcast:focal_px", camera.focal_px);
    spec.attribute("fieldcast:principal_px", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::VEC2),
                   &camera.principal_px[0]);
    const GuardBand& band = header.guard_band;
    spec.attribute("fieldcast:guard_band_px", std::to_string(band.left_px) + " " + std::to_string(band.right_px) + " " +
                                                  std::to_string(band.top_px) + " " + std::to_string(band.bottom_px));
}

OIIO::ImageSpec part_spec(const Plane& plane, const FrameHeader& header) {
    const Layout layout = layout_of(plane.semantic);
    OIIO::ImageSpec spec(static_cast<int>(plane.width_px), static_cast<int>(plane.height_px),
                         static_cast<int>(layout.channels.size()), layout.type);
    spec.channelnames = layout.channels;
    spec.attribute("oiio:subimagename", layout.part);
    spec.attribute("compression", "zip");
    describe(spec, header);
    return spec;
}

bool write_pixels(OIIO::ImageOutput& output, const Plane& plane) {
    if (plane.format == PlaneFormat::kU32) {
        return output.write_image(OIIO::TypeDesc::UINT32, plane.bytes.data());
    }
    const std::vector<glm::vec3> pixels = unpack_plane(plane);
    return output.write_image(OIIO::TypeDesc::FLOAT, pixels.data(), sizeof(glm::vec3));
}

bool write_parts(OIIO::ImageOutput& output, const std::string& name, const SourceFrame& frame) {
    std::vector<OIIO::ImageSpec> specs;
    for (const Plane& plane : frame.planes) {
        specs.push_back(part_spec(plane, frame.header));
    }
    bool good = output.open(name, static_cast<int>(specs.size()), specs.data());
    for (std::size_t part = 0; good && part < specs.size(); ++part) {
        good = part == 0 || output.open(name, specs[part], OIIO::ImageOutput::AppendSubimage);
        good = good && write_pixels(output, frame.planes[part]);
    }
    return good && output.close();
}

} // namespace

void write_exr(const std::filesystem::path& file, const SourceFrame& frame) {
    FC_ASSERT(!frame.planes.empty(), "a frame has planes");
    const auto output = OIIO::ImageOutput::create("openexr");
    FC_ASSERT(output, "OpenImageIO writes EXR");
    // By name, not in memory: OpenImageIO 2.4 ignores the proxy for files of several parts.
    replace_file(file, [&](const std::filesystem::path& part) {
        if (!write_parts(*output, part.string(), frame)) {
            throw std::runtime_error("cannot write " + file.string() + ": " + output->geterror());
        }
    });
}

} // namespace fieldcast::image
