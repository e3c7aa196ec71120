// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/buffer_views.h"

#include <cstdint>
#include <meshoptimizer.h>

namespace fieldcast::scene {

namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";

struct Compression {
    std::span<const std::byte> source;
    std::string mode;
    std::string filter;
    std::uint64_t count = 0;
    std::uint64_t stride = 0;
};

/// A member that holds a size. tinygltf keeps extension members in an int, so larger sizes are refused earlier.
std::uint64_t size_member(const tinygltf::Value& extension, const char* key) {
    const int value = extension.Has(key) ? extension.Get(key).GetNumberAsInt() : 0;
    return value < 0 ? 0 : static_cast<std::uint64_t>(value);
}

std::string text_member(const tinygltf::Value& extension, const char* key) {
    return extension.Has(key) ? extension.Get(key).Get<std::string>() : std::string();
}

Compression read_compression(const GltfDocument& document, const tinygltf::Value& extension,
                             const std::string& object) {
    const std::uint64_t index = size_member(extension, "buffer");
    const std::uint64_t offset = size_member(extension, "byteOffset");
    const std::uint64_t length = size_member(extension, "byteLength");
    if (!extension.Has("buffer") || index >= document.buffers.size()) {
        document.refuse(object, "compressed data has no buffer; the extension must name one of the file");
    }
    const std::span<const std::byte> buffer = document.buffers[index].bytes;
    if (length == 0 || offset + length > buffer.size()) {
        document.refuse(object,
                        "compressed data lies outside its buffer of " + std::to_string(buffer.size()) + " bytes");
    }
    return {buffer.subspan(offset, length), text_member(extension, "mode"), text_member(extension, "filter"),
            size_member(extension, "count"), size_member(extension, "byteStride")};
}

/// The most bytes that `source` can decode to. The vertex codec needs at least two bits per 16 values of one byte lane,
/// the index codecs at least one byte per triangle or index. The limit keeps small files from claiming huge arrays.
std::uint64_t max_decoded_bytes(const Compression& compression) {
    const std::uint64_t size = compression.source.size();
    if (compression.mode == "ATTRIBUTES") {
        return size * 64;
    }
    return size * compression.stride * (compression.mode == "TRIANGLES" ? 3 : 1);
}

void check_compression(const GltfDocument& document, const Compression& c, std::uint64_t byte_length,
                       const std::string& object) {
    const bool is_vertices = c.mode == "ATTRIBUTES";
    if (!is_vertices && c.mode != "TRIANGLES" && c.mode != "INDICES") {
        document.refuse(object, "unknown compression mode '" + c.mode.substr(0, 20) +
                                    "'; expected ATTRIBUTES, TRIANGLES or INDICES");
    }
    const bool fits_mode = is_vertices ? c.stride >= 4 && c.stride <= 256 && c.stride % 4 == 0
                                       : (c.stride == 2 || c.stride == 4) && (c.mode == "INDICES" || c.count % 3 == 0);
    const bool fits_filter =
        c.filter.empty() || c.filter == "NONE" ||
        (is_vertices && ((c.filter == "OCTAHEDRAL" && (c.stride == 4 || c.stride == 8)) ||
                         (c.filter == "QUATERNION" && c.stride == 8) || c.filter == "EXPONENTIAL"));
    if (!fits_mode || !fits_filter) {
        document.refuse(object, "stride, count or filter does not fit compression mode " + c.mode);
    }
    if (c.count == 0 || c.count * c.stride != byte_length) { // both below 2³²
        document.refuse(object,
                        "compressed count times byteStride is not its byteLength of " + std::to_string(byte_length));
    }
    if (byte_length > max_decoded_bytes(c)) {
        document.refuse(object, std::to_string(c.source.size()) + " compressed bytes cannot hold " +
                                    std::to_string(c.count) + " elements");
    }
}

int decode(const Compression& c, std::vector<std::byte>& out) {
    const auto* source = reinterpret_cast<const unsigned char*>(c.source.data());
    if (c.mode == "TRIANGLES") {
        return meshopt_decodeIndexBuffer(out.data(), c.count, c.stride, source, c.source.size());
    }
    if (c.mode == "INDICES") {
        return meshopt_decodeIndexSequence(out.data(), c.count, c.stride, source, c.source.size());
    }
    const int result = meshopt_decodeVertexBuffer(out.data(), c.count, c.stride, source, c.source.size());
    if (result != 0) {
        return result;
    }
    if (c.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(out.data(), c.count, c.stride);
    } else if (c.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(out.data(), c.count, c.stride);
    } else if (c.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), c.count, c.stride);
    }
    return 0;
}

} // namespace

std::span<const std::byte> GltfBufferViews::bytes(int view) {
    const tinygltf::BufferView& entry = document_.model.bufferViews[static_cast<std::size_t>(view)];
    if (entry.extensions.contains(kExtension)) {
        return decoded_bytes(view);
    }
    const GltfBuffer& buffer = document_.buffers[static_cast<std::size_t>(entry.buffer)];
    if (buffer.bytes.empty()) {
        document_.refuse(object_name("bufferView", static_cast<std::size_t>(view), entry.name),
                         "refers to a fallback buffer, which has no data, but is not compressed");
    }
    return buffer.bytes.subspan(entry.byteOffset, entry.byteLength);
}

void GltfBufferViews::take_bytes(std::uint64_t size, const std::string& object) {
    if (size > bytes_left_) {
        document_.refuse(object, "decompressed data exceeds the limit on the size of all files; use a simpler scene");
    }
    bytes_left_ -= size;
}

std::span<const std::byte> GltfBufferViews::decoded_bytes(int view) {
    if (const auto found = decoded_.find(view); found != decoded_.end()) {
        return found->second;
    }
    const tinygltf::BufferView& entry = document_.model.bufferViews[static_cast<std::size_t>(view)];
    const std::string object = object_name("bufferView", static_cast<std::size_t>(view), entry.name);
    const Compression compression = read_compression(document_, entry.extensions.at(kExtension), object);
    check_compression(document_, compression, entry.byteLength, object);
    take_bytes(entry.byteLength, object);
    std::vector<std::byte> out(entry.byteLength);
    if (decode(compression, out) != 0) {
        document_.refuse(object, "compressed data is broken; export the file again");
    }
    return decoded_.emplace(view, std::move(out)).first->second;
}

} // namespace fieldcast::scene
