// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/foreign_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace fieldcast::scene {

namespace {

struct Format {
    std::string_view name;
    std::string_view extension; ///< of its files, in lower case
    std::string_view beginning; ///< first bytes of every file; empty: there is nothing that all files begin with
    std::string_view converter;
};

constexpr std::string_view kBlender = "Blender (import it, then File > Export > glTF 2.0)";

// ASCII FBX begins with a comment, OBJ with any statement, COLLADA and X3D with the same XML declaration.
constexpr std::array kFormats{
    Format{"FBX", ".fbx", "Kaydara FBX Binary", "FBX2glTF or Blender (import it, then File > Export > glTF 2.0)"},
    Format{"OBJ", ".obj", "", "obj2gltf or Blender (import it, then File > Export > glTF 2.0)"},
    Format{"USD", ".usdc", "PXR-USDC", kBlender},
    Format{"USD", ".usda", "#usda", kBlender},
    Format{"USD", ".usd", "", kBlender},
    Format{"USDZ", ".usdz", "", kBlender},
    Format{"PLY", ".ply", "ply", kBlender},
    Format{"STL", ".stl", "", kBlender},
    Format{"COLLADA", ".dae", "", "COLLADA2GLTF or Blender (import it, then File > Export > glTF 2.0)"},
    Format{"Alembic", ".abc", "Ogawa", kBlender},
    Format{"3DS", ".3ds", "", kBlender},
    Format{"X3D", ".x3d", "", kBlender},
    Format{"a Blender file", ".blend", "BLENDER", "Blender (File > Export > glTF 2.0)"},
};

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

} // namespace

std::optional<std::string> foreign_format(std::span<const std::byte> bytes, const std::string& file) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string name = lower_case(file);
    const auto has_beginning = [&](const Format& format) {
        return !format.beginning.empty() && text.starts_with(format.beginning);
    };
    auto found = std::ranges::find_if(kFormats, has_beginning);
    if (found == kFormats.end()) {
        found = std::ranges::find_if(kFormats, [&](const Format& format) { return name.ends_with(format.extension); });
    }
    if (found == kFormats.end()) {
        return std::nullopt;
    }
    return "this is " + std::string(found->name) + "; convert it to glTF 2.0, .gltf or .glb, for example with " +
           std::string(found->converter);
}

} // namespace fieldcast::scene
