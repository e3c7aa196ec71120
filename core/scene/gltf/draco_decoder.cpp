// SPDX-License-Identifier: Apache-2.0
// Draco allocates arrays of the size that its data claims. A few bytes can claim 2³² / 3 triangles, and entropy coding
// gives a regular mesh nearly zero bits per triangle. So the decoders are derived from: they look at the counts before
// Draco does, and at the attributes before their values are decoded. These bounds apply:
//
//   connectivity   triangles = the count of the glTF file; ≤ the limit of the scene and kTrianglesPerByte per byte
//   vertices       ≤ 3 per triangle (Draco's own check); the count of the glTF file, after the connectivity is known
//   attributes     vertices times the sizes of their values ≤ max_bytes, before their arrays are allocated
//   orientations   of texture coordinates ≤ 1 per corner. Draco accepts 2³¹, which take 10 s and 256 MiB, and calls no
//                  function that a derived class could replace. So this file defines that function of Draco itself, as
//                  specialisations; the linker prefers them to the library's templates, which are weak symbols.
//
// Not bounded by these, but by Draco itself: tables of entropy coders (at most 64 entries per compressed byte, and 2²⁰)
// and metadata (not larger than the data). Memory that the system refuses anyway becomes an error.
#include "core/scene/gltf/draco_decoder.h"

#include <algorithm>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_data.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_tex_coords_decoder.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_tex_coords_portable_decoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_wrap_decoding_transform.h>
#include <draco/compression/bit_coders/rans_bit_decoder.h>
#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <new>
#include <stdexcept>
#include <string>

namespace draco {

namespace {

using Wrap = PredictionSchemeWrapDecodingTransform<int, int>;
using VertexData = MeshPredictionSchemeData<CornerTable>;
using SeamData = MeshPredictionSchemeData<MeshAttributeCornerTable>;
template <class Data> using TexCoords = MeshPredictionSchemeTexCoordsPortableDecoder<int, Wrap, Data>;
template <class Data> using OldTexCoords = MeshPredictionSchemeTexCoordsDecoder<int, Wrap, Data>;

/// Orientations are coded as changes: a zero bit differs from the one before.
template <class Predictor> bool read_orientations(DecoderBuffer& buffer, int max_count, Predictor& predictor) {
    std::int32_t count = 0;
    RAnsBitDecoder bits;
    if (!buffer.Decode(&count) || count < 0 || count > max_count || !bits.StartDecoding(&buffer)) {
        return false;
    }
    predictor.ResizeOrientations(count);
    bool orientation = true;
    for (int i = 0; i < count; ++i) {
        orientation = bits.DecodeNextBit() == orientation;
        predictor.set_orientation(i, orientation);
    }
    bits.EndDecoding();
    return true;
}

} // namespace

template <> bool TexCoords<VertexData>::DecodePredictionData(DecoderBuffer* buffer) {
    return read_orientations(*buffer, mesh_data().corner_table()->num_corners(), predictor_) &&
           MeshPredictionSchemeDecoder<int, Wrap, VertexData>::DecodePredictionData(buffer);
}

template <> bool TexCoords<SeamData>::DecodePredictionData(DecoderBuffer* buffer) {
    return read_orientations(*buffer, mesh_data().corner_table()->num_corners(), predictor_) &&
           MeshPredictionSchemeDecoder<int, Wrap, SeamData>::DecodePredictionData(buffer);
}

// The scheme of old versions has the same defect. Encoders of bitstream 2.2 do not use it.
template <> bool OldTexCoords<VertexData>::DecodePredictionData(DecoderBuffer* /*buffer*/) {
    return false;
}

template <> bool OldTexCoords<SeamData>::DecodePredictionData(DecoderBuffer* /*buffer*/) {
    return false;
}

} // namespace draco

namespace fieldcast::scene {

namespace {

/// A flat regular grid, the most compressible mesh, has 28 triangles per byte at 8192 triangles and 520 at 2²¹.
constexpr std::uint64_t kTrianglesPerByte = 1024;
/// Allowed for any number of bytes.
constexpr std::uint64_t kFreeTriangles = 1ULL << 20;
constexpr std::uint64_t kMaxAttributes = 16;
constexpr int kMaxComponents = 4; // of a glTF vertex attribute
/// Memory of Draco's tables: two indices per corner, the triangles and the order of their traversal.
constexpr std::uint64_t kBytesPerTriangle = 60;
/// Memory of the tables for one attribute that has its own seams.
constexpr std::uint64_t kSeamBytesPerTriangle = 40;

/// Sizes at the beginning of the connectivity.
struct Connectivity {
    std::uint32_t triangles = 0;
    std::uint32_t vertices = 0;        ///< edgebreaker: without those that seams add
    std::uint8_t seam_attributes = 0;  ///< attributes with their own seams
    bool is_vertex_count_final = true; ///< no seams can add vertices
};

Decoded<Connectivity> read_connectivity(draco::DecoderBuffer buffer, draco::MeshEncoderMethod method) {
    Connectivity sizes;
    bool is_read = false;
    if (method == draco::MESH_SEQUENTIAL_ENCODING) {
        is_read = draco::DecodeVarint(&sizes.triangles, &buffer) && draco::DecodeVarint(&sizes.vertices, &buffer);
    } else {
        is_read = draco::DecodeVarint(&sizes.vertices, &buffer) && draco::DecodeVarint(&sizes.triangles, &buffer) &&
                  buffer.Decode(&sizes.seam_attributes);
        sizes.is_vertex_count_final = false;
    }
    return is_read ? Decoded<Connectivity>(sizes) : decode_error("compressed data ends before its counts");
}

std::string claim(std::uint64_t found, const std::string& what, std::uint64_t expected) {
    return "compressed data has " + std::to_string(found) + " " + what + ", but the accessors declare " +
           std::to_string(expected);
}

/// The broken rule; empty: none.
std::string problem_of(const Connectivity& sizes, std::uint64_t byte_count, const DracoBounds& bounds) {
    const std::uint64_t triangles = sizes.triangles;
    if (bounds.triangles && triangles != *bounds.triangles) {
        return claim(3 * triangles, "indices", 3 * *bounds.triangles);
    }
    if (sizes.is_vertex_count_final && sizes.vertices != bounds.vertices) {
        return claim(sizes.vertices, "vertices", bounds.vertices);
    }
    if (triangles > bounds.max_triangles) {
        return "compressed data has " + std::to_string(triangles) + " triangles, but the limit of the scene leaves " +
               std::to_string(bounds.max_triangles) + "; simplify its meshes";
    }
    if (triangles > std::max(kFreeTriangles, byte_count * kTrianglesPerByte)) {
        return std::to_string(byte_count) + " compressed bytes cannot hold " + std::to_string(triangles) + " triangles";
    }
    if (sizes.seam_attributes > kMaxAttributes) {
        return "compressed data has more than " + std::to_string(kMaxAttributes) + " attributes, the limit";
    }
    if (triangles * (kBytesPerTriangle + kSeamBytesPerTriangle * sizes.seam_attributes) > bounds.max_bytes) {
        return "decompressed data exceeds the limit on the size of all files; use a simpler scene";
    }
    return {};
}

/// As above, for the attributes of a mesh whose connectivity is decoded.
std::string problem_of(const draco::Mesh& mesh, const DracoBounds& bounds) {
    if (mesh.num_points() != bounds.vertices) {
        return claim(mesh.num_points(), "vertices", bounds.vertices);
    }
    if (static_cast<std::uint64_t>(mesh.num_attributes()) > kMaxAttributes) {
        return "compressed data has more than " + std::to_string(kMaxAttributes) + " attributes, the limit";
    }
    std::uint64_t vertex_bytes = 0;
    for (int i = 0; i < mesh.num_attributes(); ++i) {
        const draco::PointAttribute& attribute = *mesh.attribute(i);
        const int components = attribute.num_components();
        if (components < 1 || components > kMaxComponents) {
            return "compressed attribute " + std::to_string(attribute.unique_id()) + " has " +
                   std::to_string(components) + " components; expected 1 to 4";
        }
        // Its values, the quantised values of 32 bits, and the map from vertices to values.
        vertex_bytes += static_cast<std::uint64_t>(attribute.byte_stride()) +
                        sizeof(std::uint32_t) * static_cast<std::uint64_t>(components + 1);
    }
    if (bounds.vertices * vertex_bytes > bounds.max_bytes) {
        return "decompressed data exceeds the limit on the size of all files; use a simpler scene";
    }
    return {};
}

/// A decoder of Draco that stops before it allocates more than the bounds allow.
template <class Decoder, draco::MeshEncoderMethod kMethod> class BoundedDecoder : public Decoder {
public:
    BoundedDecoder(std::uint64_t byte_count, const DracoBounds& bounds) : byte_count_(byte_count), bounds_(bounds) {}

    std::string problem; ///< the broken rule after a failure; empty: Draco found the data broken

protected:
    bool DecodeConnectivity() override {
        const Decoded<Connectivity> sizes = read_connectivity(*this->buffer(), kMethod);
        problem = sizes ? problem_of(*sizes, byte_count_, bounds_) : sizes.error().message;
        return problem.empty() && Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        problem = problem_of(*this->mesh(), bounds_);
        return problem.empty() && Decoder::DecodeAllAttributes();
    }

private:
    const std::uint64_t byte_count_;
    const DracoBounds& bounds_;
};

using EdgebreakerDecoder = BoundedDecoder<draco::MeshEdgebreakerDecoder, draco::MESH_EDGEBREAKER_ENCODING>;
using SequentialDecoder = BoundedDecoder<draco::MeshSequentialDecoder, draco::MESH_SEQUENTIAL_ENCODING>;

draco::DecoderBuffer buffer_of(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return buffer;
}

template <class Decoder>
Decoded<std::unique_ptr<draco::Mesh>> decode_with(std::span<const std::byte> bytes, const DracoBounds& bounds) {
    draco::DecoderBuffer buffer = buffer_of(bytes);
    const draco::DecoderOptions options;
    Decoder decoder(bytes.size(), bounds);
    auto mesh = std::make_unique<draco::Mesh>();
    if (!decoder.Decode(options, &buffer, mesh.get()).ok()) {
        return decode_error(decoder.problem.empty() ? "compressed data is broken; export the file again"
                                                    : decoder.problem);
    }
    return mesh;
}

Decoded<std::unique_ptr<draco::Mesh>> decode_mesh(std::span<const std::byte> bytes, const DracoBounds& bounds) {
    draco::DecoderBuffer buffer = buffer_of(bytes);
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) {
        return decode_error("has no Draco data; its bufferView must begin with a Draco header");
    }
    if (header.encoder_type != draco::TRIANGULAR_MESH) {
        return decode_error("Draco data is a point cloud; glTF requires a triangle mesh");
    }
    if (header.version_major != 2 || header.version_minor != 2) {
        return decode_error("Draco bitstream " + std::to_string(header.version_major) + "." +
                            std::to_string(header.version_minor) + " is not supported; glTF requires version 2.2");
    }
    switch (header.encoder_method) {
    case draco::MESH_EDGEBREAKER_ENCODING:
        return decode_with<EdgebreakerDecoder>(bytes, bounds);
    case draco::MESH_SEQUENTIAL_ENCODING:
        return decode_with<SequentialDecoder>(bytes, bounds);
    default:
        return decode_error("unknown Draco encoding " + std::to_string(header.encoder_method) + "; expected 0 or 1");
    }
}

} // namespace

Decoded<std::unique_ptr<draco::Mesh>> decode_draco(std::span<const std::byte> bytes, const DracoBounds& bounds) {
    try {
        return decode_mesh(bytes, bounds);
    } catch (const std::bad_alloc&) {
        return decode_error("decompressed data does not fit in memory; use a simpler scene");
    } catch (const std::length_error&) { // of a container that would be larger than the address space
        return decode_error("decompressed data does not fit in memory; use a simpler scene");
    }
}

} // namespace fieldcast::scene
