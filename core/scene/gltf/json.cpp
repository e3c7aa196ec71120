// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/json.h"

#include "core/base/error.h"
#include "core/scene/gltf/foreign_format.h"
#include "core/scene/load_report.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace fieldcast::scene {

namespace {

constexpr int kMaxDepth = 100;
constexpr std::uint64_t kMaxJsonBytes = 256ULL << 20;

constexpr std::uint32_t kGlbMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A; // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;  // "BIN\0"

constexpr std::array<std::string_view, 8> kSupportedExtensions{
    "EXT_meshopt_compression", "KHR_draco_mesh_compression", "KHR_lights_punctual",   "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_transmission", "KHR_mesh_quantization", "KHR_texture_transform"};

std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) {
        value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8U * i);
    }
    return value;
}

struct Chunks {
    std::span<const std::byte> json;
    std::span<const std::byte> binary;
};

/// Splits a .glb into its chunks. A file without the magic of a .glb is JSON as a whole.
Chunks split_container(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.size() < 4 || u32_at(bytes, 0) != kGlbMagic) {
        return {bytes, {}};
    }
    if (bytes.size() < 20 || u32_at(bytes, 4) != 2) {
        refuse(file, "glb header", bytes.size() < 20 ? "file is truncated; a .glb has at least 20 bytes"
                                                      : "only version 2 is supported; export the scene as glTF 2.0");
    }
    const std::size_t length = u32_at(bytes, 8);
    if (length < 20 || length > bytes.size()) {
        refuse(file, "glb header",
               "claims " + std::to_string(length) + " bytes, but the file has " + std::to_string(bytes.size()));
    }
    Chunks chunks;
    bool is_first = true;
    for (std::span<const std::byte> rest = bytes.subspan(12, length - 12); rest.size() >= 8; is_first = false) {
        const std::size_t size = u32_at(rest, 0);
        const std::uint32_t type = u32_at(rest, 4);
        if (size > rest.size() - 8) {
            refuse(file, "glb chunk", "claims " + std::to_string(size) + " bytes and ends beyond the end of the file");
        }
        if (is_first != (type == kJsonChunk)) {
            refuse(file, "glb chunk", is_first ? "the first chunk is not JSON" : "only the first chunk may be JSON");
        }
        if (is_first) {
            chunks.json = rest.subspan(8, size);
        } else if (type == kBinChunk && chunks.binary.empty()) {
            chunks.binary = rest.subspan(8, size);
        }
        rest = rest.subspan(8 + size);
    }
    return chunks;
}

/// Line and column of byte number `byte` (from 1), for messages.
std::string place_in(std::span<const std::byte> text, std::size_t byte) {
    const auto before = text.first(std::min(text.size(), std::max(byte, std::size_t{1}) - 1));
    const auto lines = std::ranges::count(before, std::byte{'\n'});
    const auto last = std::ranges::find(before.rbegin(), before.rend(), std::byte{'\n'});
    return "line " + std::to_string(lines + 1) + ", column " + std::to_string(last - before.rbegin() + 1);
}

nlohmann::json parse_text(std::span<const std::byte> text, const std::string& file) {
    if (text.size() > kMaxJsonBytes) {
        refuse(file, "json", "is larger than 256 MiB, the limit");
    }
    const char* begin = reinterpret_cast<const char*>(text.data());
    const auto check_depth = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
        if (depth > kMaxDepth) {
            refuse(file, "json", "is nested deeper than " + std::to_string(kMaxDepth) + " levels, the limit");
        }
        return true;
    };
    try {
        return nlohmann::json::parse(begin, begin + text.size(), check_depth);
    } catch (const nlohmann::json::parse_error& error) {
        if (const auto problem = foreign_format(text, file)) {
            refuse(file, "format", *problem);
        }
        refuse(file, "json",
               place_in(text, error.byte) + ": this is not JSON; a scene must be a glTF 2.0 file, .gltf or .glb");
    } catch (const nlohmann::json::exception&) {
        refuse(file, "json", "holds a number beyond the range of double precision");
    }
}

const nlohmann::json* find_object(const nlohmann::json& parent, const char* key) {
    const auto found = parent.find(key);
    return found != parent.end() && found->is_object() ? &*found : nullptr;
}

void check_version(const nlohmann::json& root, const std::string& file) {
    const nlohmann::json* asset = find_object(root, "asset");
    if (asset == nullptr || !asset->contains("version") || !asset->at("version").is_string()) {
        refuse(file, "asset", "has no version; glTF 2.0 requires it");
    }
    const auto version = asset->at("version").get<std::string>();
    if (!version.starts_with("2.")) {
        refuse(file, "asset", "version " + version.substr(0, 20) + " is not supported; export the scene as glTF 2.0");
    }
    const auto minimum = asset->find("minVersion");
    if (minimum != asset->end() && *minimum != "2.0") {
        refuse(file, "asset", "needs a newer version than 2.0; export the scene as glTF 2.0");
    }
}

void check_required_extensions(const nlohmann::json& root, const std::string& file) {
    const auto required = root.find("extensionsRequired");
    if (required == root.end()) {
        return;
    }
    for (const nlohmann::json& entry : *required) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : std::string();
        if (!is_supported_extension(name)) {
            refuse(file, "extensionsRequired",
                   "extension '" + name.substr(0, 60) + "' is not supported; export without it");
        }
    }
}

} // namespace

bool is_supported_extension(std::string_view name) {
    return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), name) != kSupportedExtensions.end();
}

GltfJson parse_gltf_json(std::span<const std::byte> bytes, const std::string& file) {
    const Chunks chunks = split_container(bytes, file);
    GltfJson json{parse_text(chunks.json, file), chunks.binary};
    if (!json.root.is_object()) {
        refuse(file, "json", "the root is not an object; a glTF file is one JSON object");
    }
    check_version(json.root, file);
    check_gltf_properties(json.root, file);
    check_required_extensions(json.root, file);
    return json;
}

} // namespace fieldcast::scene
