// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/gltf_builder.h"

#include "core/base/error.h"
#include "core/image/image_file.h"

#include <atomic>
#include <fstream>
#include <unistd.h>

namespace fieldcast::scene {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::size_t components(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

void append_u32(std::string& text, std::size_t value) {
    for (unsigned i = 0; i < 4; ++i) {
        text += static_cast<char>(value >> (8U * i) & 0xFFU);
    }
}

void append_chunk(std::string& text, std::size_t type, std::string chunk, char padding) {
    chunk.resize((chunk.size() + 3) / 4 * 4, padding);
    append_u32(text, chunk.size());
    append_u32(text, type);
    text += chunk;
}

} // namespace

TempFolder::TempFolder() {
    static std::atomic<int> next = 0;
    path_ = fs::temp_directory_path() / ("fieldcast_scene_" + std::to_string(getpid()) + "_" + std::to_string(next++));
    fs::remove_all(path_);
    fs::create_directories(path_);
}

TempFolder::~TempFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path TempFolder::write(const std::string& name, std::span<const std::byte> bytes) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream stream(path_ / name, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
}

fs::path TempFolder::write(const std::string& name, const std::string& text) const {
    return write(name, std::as_bytes(std::span(text)));
}

GltfBuilder::GltfBuilder() : json({{"asset", {{"version", "2.0"}}}, {"scene", 0}}) {
    json["scenes"].push_back({{"nodes", json::array()}});
}

int GltfBuilder::add(const char* list, nlohmann::json entry) {
    json[list].push_back(std::move(entry));
    return static_cast<int>(json[list].size()) - 1;
}

int GltfBuilder::add_view(std::span<const std::byte> bytes, int stride) {
    binary.resize((binary.size() + 3) / 4 * 4);
    nlohmann::json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) {
        view["byteStride"] = stride;
    }
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
}

int GltfBuilder::add_accessor(std::span<const std::byte> bytes, std::size_t value_count, const char* type,
                              int component_type, bool is_normalised) {
    nlohmann::json accessor{{"bufferView", add_view(bytes)},
                            {"componentType", component_type},
                            {"count", value_count / components(type)},
                            {"type", type}};
    if (is_normalised) {
        accessor["normalized"] = true;
    }
    return add("accessors", std::move(accessor));
}

int GltfBuilder::add_texture() {
    const int view = add_view(small_png(2, 1));
    const int image = add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    return add("textures", {{"source", image}});
}

int GltfBuilder::add_node(nlohmann::json node) {
    const int index = add("nodes", std::move(node));
    json["scenes"][0]["nodes"].push_back(index);
    return index;
}

int GltfBuilder::add_mesh(nlohmann::json primitive) {
    return add("meshes", {{"primitives", nlohmann::json::array({std::move(primitive)})}});
}

int GltfBuilder::add_triangle() {
    const int position = add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int normal = add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int mesh = add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
    add_node({{"name", "triangle"}, {"mesh", mesh}});
    return mesh;
}

std::string GltfBuilder::gltf() const {
    nlohmann::json document = json;
    if (!binary.empty() && !document.contains("buffers")) {
        document["buffers"].push_back(
            {{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}});
    }
    return document.dump();
}

std::vector<std::byte> GltfBuilder::glb() const {
    nlohmann::json document = json;
    if (!document.contains("buffers")) {
        document["buffers"].push_back({{"byteLength", binary.size()}});
    }
    std::string chunks;
    append_chunk(chunks, 0x4E4F534A, document.dump(), ' ');
    append_chunk(chunks, 0x004E4942, std::string(reinterpret_cast<const char*>(binary.data()), binary.size()), '\0');
    std::string text;
    append_u32(text, 0x46546C67);
    append_u32(text, 2);
    append_u32(text, chunks.size() + 12);
    text += chunks;
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

Scene GltfBuilder::load(const LoadOptions& options) const {
    const TempFolder folder;
    return load_scene(folder.write("test.gltf", gltf()), options);
}

std::string refusal(const fs::path& file, const LoadOptions& options) {
    try {
        load_scene(file, options);
    } catch (const UserError& error) {
        return error.what();
    }
    return "(the file was accepted)";
}

std::string refusal(const GltfBuilder& builder, const LoadOptions& options) {
    const TempFolder folder;
    return refusal(folder.write("test.gltf", builder.gltf()), options);
}

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            bits = bits << 8U | (i + j < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + j]) : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += i + j > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * j) & 63U];
        }
    }
    return text;
}

std::vector<std::byte> small_png(std::uint32_t width, std::uint32_t height) {
    image::Rgba8 image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 255)};
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        image.pixels[i] = static_cast<std::uint8_t>(10 * i);
    }
    return image::encode_png(image);
}

} // namespace fieldcast::scene
