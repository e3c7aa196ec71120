// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/draco_builder.h"

#include "core/base/error.h"

#include <array>
#include <cmath>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

namespace fieldcast::scene {

namespace {

template <class Value, class Member>
void add_values(draco::TriangleSoupMeshBuilder& builder, int attribute, const Corners& corners, Member member) {
    for (std::uint32_t i = 0; 3 * i < corners.size(); ++i) {
        const std::array<Value, 3> values{member(corners[3 * i]), member(corners[3 * i + 1]),
                                          member(corners[3 * i + 2])};
        builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(i), &values[0], &values[1], &values[2]);
    }
}

} // namespace

Corners draco_sheet(int size) {
    Corners corners;
    const auto add = [&](int x, int y, bool is_right) {
        const auto fx = static_cast<float>(x);
        const auto fy = static_cast<float>(y);
        corners.push_back({{fx, fy, std::sin(fx) * std::cos(fy)},
                           glm::normalize(glm::vec3(is_right ? 1.0F : -1.0F, 0.1F * fy, 1.0F)),
                           {fx / 8.0F, fy / 8.0F + (is_right ? 1.0F : 0.0F)},
                           {20 * x, 30 * y, is_right ? 255 : 0, 255},
                           {0.0F, 1.0F, 0.0F, is_right ? 1.0F : -1.0F}});
    };
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const std::array<glm::ivec2, 6> cell{{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}};
            for (const glm::ivec2 at : cell) {
                add(x + at.x, y + at.y, 2 * x >= size);
            }
        }
    }
    return corners;
}

std::unique_ptr<draco::Mesh> draco_mesh(const Corners& corners) {
    using draco::GeometryAttribute;
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(corners.size() / 3));
    const auto add = [&](GeometryAttribute::Type type, std::int8_t components, draco::DataType data) {
        return builder.AddAttribute(type, components, data);
    };
    add_values<glm::vec3>(builder, add(GeometryAttribute::POSITION, 3, draco::DT_FLOAT32), corners,
                          [](const Corner& corner) { return corner.position; });
    add_values<glm::vec3>(builder, add(GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32), corners,
                          [](const Corner& corner) { return corner.normal; });
    add_values<glm::vec2>(builder, add(GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32), corners,
                          [](const Corner& corner) { return corner.uv; });
    add_values<glm::u8vec4>(builder, add(GeometryAttribute::COLOR, 4, draco::DT_UINT8), corners,
                            [](const Corner& corner) { return corner.colour; });
    add_values<glm::vec4>(builder, add(GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32), corners,
                          [](const Corner& corner) { return corner.tangent; });
    std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    for (int i = 0; i < mesh->num_attributes(); ++i) {
        mesh->attribute(i)->set_unique_id(static_cast<std::uint32_t>(kFirstId + i));
    }
    return mesh;
}

std::vector<std::byte> bytes_of(const draco::EncoderBuffer& buffer) {
    const auto bytes = std::as_bytes(std::span(buffer.data(), buffer.size()));
    return {bytes.begin(), bytes.end()};
}

DracoData draco_encode(const draco::Mesh& mesh, int method, int speed) {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetSpeedOptions(speed, speed);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 12);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::GENERIC, 12);
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    FC_ASSERT(encoder.EncodeMeshToBuffer(mesh, &buffer).ok(), "Draco encodes the mesh");
    return {bytes_of(buffer), encoder.num_encoded_points(), encoder.num_encoded_faces()};
}

DracoBuilder::DracoBuilder(const DracoData& data) {
    json["extensionsUsed"] = json["extensionsRequired"] = {kDraco};
    const auto add_accessor = [&](const char* type, int component_type, std::size_t count) {
        return add("accessors", {{"componentType", component_type}, {"count", count}, {"type", type}});
    };
    const std::size_t count = data.vertices;
    const int position = add_accessor("VEC3", kF32, count);
    const int normal = add_accessor("VEC3", kF32, count);
    const int uv = add_accessor("VEC2", kF32, count);
    const int colour = add_accessor("VEC4", kU8, count);
    json["accessors"][static_cast<std::size_t>(colour)]["normalized"] = true;
    const int tangent = add_accessor("VEC4", kF32, count);
    const int indices = add_accessor("SCALAR", kU16, 3 * data.triangles);
    add_node({{"mesh", add_mesh({{"attributes",
                                  {{"POSITION", position},
                                   {"NORMAL", normal},
                                   {"TEXCOORD_0", uv},
                                   {"COLOR_0", colour},
                                   {"TANGENT", tangent}}},
                                 {"indices", indices}})}});
    primitive()["extensions"][kDraco] = {{"bufferView", add_view(data.bytes)},
                                         {"attributes",
                                          {{"POSITION", kFirstId},
                                           {"NORMAL", kFirstId + 1},
                                           {"TEXCOORD_0", kFirstId + 2},
                                           {"COLOR_0", kFirstId + 3},
                                           {"TANGENT", kFirstId + 4}}}};
}

} // namespace fieldcast::scene
