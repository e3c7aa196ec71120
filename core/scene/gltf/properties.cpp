// SPDX-License-Identifier: Apache-2.0
// Types and ranges of glTF properties, by name. In glTF 2.0 and the supported extensions, nearly every name has one
// meaning, so one table replaces a schema.
#include "core/scene/gltf/json.h"
#include "core/scene/load_report.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

namespace fieldcast::scene {

namespace {

using nlohmann::json;

enum class Kind {
    kIndex,     // integer 0 … 2³¹ − 1
    kSize,      // integer 0 … 2⁵³
    kIndexList, // array of indices
    kIndexMap,  // object of indices
    kNumber,    // number
    kNumbers,   // number or array of numbers
    kBoolean,
    kString,
    kStrings, // array of strings
    kObjects, // array of objects
    kObject,
};

const std::unordered_map<std::string_view, Kind> kKinds{
    {"buffer", Kind::kIndex},
    {"bufferView", Kind::kIndex},
    {"camera", Kind::kIndex},
    {"componentType", Kind::kIndex},
    {"index", Kind::kIndex},
    {"input", Kind::kIndex},
    {"light", Kind::kIndex},
    {"magFilter", Kind::kIndex},
    {"material", Kind::kIndex},
    {"mesh", Kind::kIndex},
    {"minFilter", Kind::kIndex},
    {"node", Kind::kIndex},
    {"output", Kind::kIndex},
    {"sampler", Kind::kIndex},
    {"scene", Kind::kIndex},
    {"skin", Kind::kIndex},
    {"source", Kind::kIndex},
    {"texCoord", Kind::kIndex},
    {"wrapS", Kind::kIndex},
    {"wrapT", Kind::kIndex},
    {"byteLength", Kind::kSize},
    {"byteOffset", Kind::kSize},
    {"byteStride", Kind::kSize},
    {"count", Kind::kSize},
    {"children", Kind::kIndexList},
    {"joints", Kind::kIndexList},
    {"attributes", Kind::kIndexMap},
    {"alphaCutoff", Kind::kNumber},
    {"aspectRatio", Kind::kNumber},
    {"emissiveStrength", Kind::kNumber},
    {"innerConeAngle", Kind::kNumber},
    {"intensity", Kind::kNumber},
    {"ior", Kind::kNumber},
    {"metallicFactor", Kind::kNumber},
    {"outerConeAngle", Kind::kNumber},
    {"range", Kind::kNumber},
    {"roughnessFactor", Kind::kNumber},
    {"strength", Kind::kNumber},
    {"transmissionFactor", Kind::kNumber},
    {"yfov", Kind::kNumber},
    {"zfar", Kind::kNumber},
    {"znear", Kind::kNumber},
    {"baseColorFactor", Kind::kNumbers},
    {"color", Kind::kNumbers},
    {"emissiveFactor", Kind::kNumbers},
    {"matrix", Kind::kNumbers},
    {"max", Kind::kNumbers},
    {"min", Kind::kNumbers},
    {"offset", Kind::kNumbers},
    {"rotation", Kind::kNumbers}, // of a node: four; of KHR_texture_transform: one
    {"scale", Kind::kNumbers},    // of a node: three; of a normal texture: one
    {"translation", Kind::kNumbers},
    {"weights", Kind::kNumbers},
    {"doubleSided", Kind::kBoolean},
    {"fallback", Kind::kBoolean},
    {"normalized", Kind::kBoolean},
    {"alphaMode", Kind::kString},
    {"filter", Kind::kString},
    {"interpolation", Kind::kString},
    {"mimeType", Kind::kString},
    {"name", Kind::kString},
    {"path", Kind::kString},
    {"type", Kind::kString},
    {"uri", Kind::kString},
    {"accessors", Kind::kObjects},
    {"animations", Kind::kObjects},
    {"bufferViews", Kind::kObjects},
    {"buffers", Kind::kObjects},
    {"cameras", Kind::kObjects},
    {"channels", Kind::kObjects},
    {"extensionsRequired", Kind::kStrings},
    {"extensionsUsed", Kind::kStrings},
    {"images", Kind::kObjects},
    {"lights", Kind::kObjects},
    {"materials", Kind::kObjects},
    {"meshes", Kind::kObjects},
    {"nodes", Kind::kObjects},
    {"primitives", Kind::kObjects},
    {"samplers", Kind::kObjects},
    {"scenes", Kind::kObjects},
    {"skins", Kind::kObjects},
    {"targets", Kind::kObjects},
    {"textures", Kind::kObjects},
    {"baseColorTexture", Kind::kObject},
    {"emissiveTexture", Kind::kObject},
    {"extensions", Kind::kObject},
    {"metallicRoughnessTexture", Kind::kObject},
    {"normalTexture", Kind::kObject},
    {"occlusionTexture", Kind::kObject},
    {"orthographic", Kind::kObject},
    {"pbrMetallicRoughness", Kind::kObject},
    {"perspective", Kind::kObject},
    {"sparse", Kind::kObject},
    {"spot", Kind::kObject},
    {"transmissionTexture", Kind::kObject},
    {"values", Kind::kObject},
};

constexpr std::uint64_t kMaxIndex = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMaxSize = 1ULL << 53U;

bool is_integer_up_to(const json& value, std::uint64_t limit) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= limit;
}

template <class Predicate> bool all_of(const json& container, Predicate predicate) {
    for (const json& element : container) {
        if (!predicate(element)) {
            return false;
        }
    }
    return true;
}

bool is_index(const json& value) {
    return is_integer_up_to(value, kMaxIndex);
}

/// The problem of a `value` that is not of `kind`; null if it is.
const char* mismatch(const json& value, Kind kind) {
    switch (kind) {
    case Kind::kIndex:
        return is_index(value) ? nullptr : "is not an integer between 0 and 2147483647";
    case Kind::kSize:
        return is_integer_up_to(value, kMaxSize) ? nullptr : "is not an integer between 0 and 2^53";
    case Kind::kIndexList:
        return value.is_array() && all_of(value, is_index) ? nullptr : "is not a list of indices";
    case Kind::kIndexMap:
        return value.is_object() && all_of(value, is_index) ? nullptr : "is not a set of indices";
    case Kind::kNumber:
        return value.is_number() ? nullptr : "is not a number";
    case Kind::kNumbers: {
        const bool matches = value.is_array() && all_of(value, [](const json& element) { return element.is_number(); });
        return matches || value.is_number() ? nullptr : "is not a number or a list of numbers";
    }
    case Kind::kBoolean:
        return value.is_boolean() ? nullptr : "is not true or false";
    case Kind::kString:
        return value.is_string() ? nullptr : "is not a string";
    case Kind::kStrings: {
        const bool matches = value.is_array() && all_of(value, [](const json& element) { return element.is_string(); });
        return matches ? nullptr : "is not a list of strings";
    }
    case Kind::kObjects: {
        const bool matches = value.is_array() && all_of(value, [](const json& element) { return element.is_object(); });
        return matches ? nullptr : "is not a list of objects";
    }
    case Kind::kObject:
        return value.is_object() ? nullptr : "is not an object";
    }
    return nullptr;
}

/// Path of the visited value. The text is made only for messages.
struct Place {
    const Place* parent = nullptr;
    std::string_view key;
    std::size_t index = 0;

    std::string text() const {
        const std::string own = key.empty() ? std::to_string(index) : std::string(key.substr(0, 60));
        return parent == nullptr ? std::string() : parent->text() + (parent->parent == nullptr ? "" : "/") + own;
    }
};

class PropertyVisitor {
public:
    explicit PropertyVisitor(const std::string& file) : file_(file) {}

    /// Checks `value` recursively; the parser limits the depth.
    void visit(const json& value, const Place& place) const {
        if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i) {
                check(value[i], place.key == "targets" ? std::optional(Kind::kIndexMap) : std::nullopt, place);
                visit(value[i], {&place, {}, i});
            }
        } else if (value.is_object()) {
            for (const auto& [key, member] : value.items()) {
                visit_member(key, member, {&place, key, 0});
            }
        }
    }

private:
    void visit_member(const std::string& key, const json& member, const Place& place) const {
        const bool is_in_extensions = place.parent->key == "extensions";
        if (key == "extras" || key == "asset" || (is_in_extensions && !is_supported_extension(key))) {
            return; // these may hold anything
        }
        check(member, kind_of(key, member, place), place);
        visit(member, place);
    }

    void check(const json& value, std::optional<Kind> kind, const Place& place) const {
        const char* problem = kind ? mismatch(value, *kind) : nullptr;
        if (problem != nullptr) {
            refuse(file_, place.text(), problem);
        }
    }

    static std::optional<Kind> kind_of(const std::string& key, const json& member, const Place& place) {
        const std::string_view parent = place.parent->key;
        if (parent == "extensions") {
            return Kind::kObject;
        }
        if (key == "nodes" && place.parent->parent != nullptr) {
            return Kind::kIndexList; // nodes of a scene, not the list of all nodes
        }
        if ((key == "indices" && parent != "sparse") || (key == "mode" && !member.is_string())) {
            return Kind::kIndex; // member of a primitive
        }
        if (key == "indices") {
            return Kind::kObject;
        }
        const bool is_in_sparse = parent == "sparse" || (place.parent->parent && place.parent->parent->key == "sparse");
        if (is_in_sparse && (key == "count" || key == "byteOffset")) {
            return Kind::kIndex; // tinygltf keeps them in an int
        }
        if (key == "target" && !member.is_object()) {
            return Kind::kIndex; // member of a buffer view
        }
        const auto found = kKinds.find(key);
        if (parent == "EXT_meshopt_compression" && found != kKinds.end() && found->second == Kind::kSize) {
            return Kind::kIndex; // tinygltf keeps these in an int, too
        }
        return found == kKinds.end() ? std::nullopt : std::optional(found->second);
    }

    const std::string& file_;
};

} // namespace

void check_gltf_properties(const json& root, const std::string& file) {
    PropertyVisitor(file).visit(root, {});
}

} // namespace fieldcast::scene
