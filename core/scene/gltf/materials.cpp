// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/materials.h"

#include "core/scene/gltf/numbers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace fieldcast::scene {

namespace {

/// Range of factors from 0 to 1. Values up to 1.001, from an exporter's rounding, are clamped to 1.
constexpr Range kUnitRange{0.0, 1.001};
constexpr double kMaxIor = 10.0;

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

class SurfaceReader {
public:
    explicit SurfaceReader(GltfDocument& document) : document_(document) {}

    GltfSurfaces read() {
        const auto& sources = document_.model.materials;
        if (sources.size() + 1 > kMaxMaterials) {
            document_.refuse("materials", std::to_string(sources.size()) + " exceed the limit of " +
                                              std::to_string(kMaxMaterials - 1) + "; merge equal materials");
        }
        for (std::size_t i = 0; i < sources.size(); ++i) {
            surfaces_.materials.push_back(read_material(sources[i], object_name("material", i, sources[i].name)));
        }
        surfaces_.materials.emplace_back().name = "default";
        return std::move(surfaces_);
    }

private:
    Material read_material(const tinygltf::Material& source, const std::string& object) {
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        const auto number = [&](double value, const char* what, const Range& range) {
            return checked_float(document_, value, object + ": " + what, range);
        };
        Material material;
        material.name = source.name;
        material.base_colour_factor = glm::min(
            checked_vector<glm::vec4>(document_, pbr.baseColorFactor, object + ": baseColorFactor", kUnitRange), 1.0F);
        material.metallic_factor = std::min(number(pbr.metallicFactor, "metallicFactor", kUnitRange), 1.0F);
        material.roughness_factor = std::min(number(pbr.roughnessFactor, "roughnessFactor", kUnitRange), 1.0F);
        material.normal_scale = number(source.normalTexture.scale, "normalTexture scale", kTextureRange);
        material.alpha_mode = alpha_mode(source.alphaMode, object);
        material.alpha_cutoff = number(source.alphaCutoff, "alphaCutoff", {});
        material.double_sided = source.doubleSided;
        material.base_colour = use_texture(pbr.baseColorTexture, object);
        material.metallic_roughness = use_texture(pbr.metallicRoughnessTexture, object);
        material.normal = use_texture(source.normalTexture, object);
        material.emissive = use_texture(source.emissiveTexture, object);
        read_emission(source, object, material);
        read_dielectric(source, object, material);
        return material;
    }

    void read_emission(const tinygltf::Material& source, const std::string& object, Material& material) {
        const auto factor =
            checked_vector<glm::vec3>(document_, source.emissiveFactor, object + ": emissiveFactor", {});
        double strength = 1.0;
        if (const auto* extension = find_extension(source.extensions, "KHR_materials_emissive_strength")) {
            strength = number_member(*extension, "emissiveStrength", 1.0);
        }
        for (int i = 0; i < 3; ++i) {
            material.emissive_factor[i] = checked_float(document_, strength * static_cast<double>(factor[i]),
                                                        object + ": emission", kEmissionRange);
        }
    }

    void read_dielectric(const tinygltf::Material& source, const std::string& object, Material& material) {
        if (const auto* extension = find_extension(source.extensions, "KHR_materials_ior")) {
            const double ior = number_member(*extension, "ior", 1.5);
            // In this extension, 0 means that the surface reflects all light.
            material.ior = checked_float(document_, ior, object + ": ior", {ior == 0.0 ? 0.0 : 1.0, kMaxIor});
        }
        if (const auto* extension = find_extension(source.extensions, "KHR_materials_transmission")) {
            const double factor = number_member(*extension, "transmissionFactor", 0.0);
            material.transmission_factor =
                std::min(checked_float(document_, factor, object + ": transmissionFactor", kUnitRange), 1.0F);
            if (extension->Has("transmissionTexture")) {
                material.transmission = use_texture(extension->Get("transmissionTexture"), object);
            }
        }
    }

    AlphaMode alpha_mode(const std::string& mode, const std::string& object) const {
        if (mode == "OPAQUE") {
            return AlphaMode::kOpaque;
        }
        if (mode != "MASK" && mode != "BLEND") {
            document_.refuse(object, "unknown alphaMode '" + mode.substr(0, 20) + "'; expected OPAQUE, MASK or BLEND");
        }
        return mode == "MASK" ? AlphaMode::kMask : AlphaMode::kBlend;
    }

    TextureUse use_texture(const tinygltf::Value& info, const std::string& object) {
        tinygltf::TextureInfo parsed;
        parsed.index = static_cast<int>(number_member(info, "index", -1.0));
        parsed.texCoord = static_cast<int>(number_member(info, "texCoord", 0.0));
        if (parsed.index < 0) {
            document_.refuse(object, "a texture has no index; it must name a texture of the file");
        }
        if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform")) {
            parsed.extensions["KHR_texture_transform"] = info.Get("extensions").Get("KHR_texture_transform");
        }
        return use_texture(parsed, object);
    }

    template <class Info> TextureUse use_texture(const Info& info, const std::string& object) {
        TextureUse use;
        if (info.index < 0) {
            return use;
        }
        if (static_cast<std::size_t>(info.index) >= document_.model.textures.size()) {
            document_.refuse(object, "texture " + std::to_string(info.index) + " does not exist");
        }
        int uv_set = info.texCoord;
        if (const auto* transform = find_extension(info.extensions, "KHR_texture_transform")) {
            uv_set = static_cast<int>(number_member(*transform, "texCoord", uv_set));
            use.uv_matrix = uv_matrix(*transform, object + ": KHR_texture_transform");
        }
        if (uv_set > 1) {
            document_.warnings.add("textures with coordinates beyond TEXCOORD_1 are ignored", "use");
            return {};
        }
        use.uv_set = static_cast<std::uint32_t>(uv_set);
        use.texture = keep_texture(info.index);
        return use;
    }

    /// Matrix translation · rotation · scale. A positive angle turns the coordinates counter-clockwise as seen in the
    /// image, whose v axis points down.
    std::array<glm::vec3, 2> uv_matrix(const tinygltf::Value& transform, const std::string& object) const {
        const auto pair = [&](const char* key, const glm::vec2& fallback) {
            return transform.Has(key)
                       ? checked_vector<glm::vec2>(document_, numbers_member(transform, key), object, kTextureRange)
                       : fallback;
        };
        const glm::vec2 offset = pair("offset", glm::vec2(0.0F));
        const glm::vec2 scale = pair("scale", glm::vec2(1.0F));
        const float angle = checked_float(document_, number_member(transform, "rotation", 0.0), object, kTextureRange);
        const float c = std::cos(angle);
        const float s = std::sin(angle);
        return {glm::vec3(c * scale.x, s * scale.y, offset.x), glm::vec3(-s * scale.x, c * scale.y, offset.y)};
    }

    /// Index into the scene's textures, to which a new texture is added; kNone if its image has no supported format.
    std::uint32_t keep_texture(int index) {
        const tinygltf::Texture& source = document_.model.textures[static_cast<std::size_t>(index)];
        if (source.source < 0) {
            document_.warnings.add("textures without an image in a supported format are ignored", "use");
            return kNone;
        }
        const auto [found, is_new] = kept_.try_emplace(index, static_cast<std::uint32_t>(surfaces_.textures.size()));
        if (is_new) {
            Texture texture;
            texture.image = static_cast<std::uint32_t>(source.source);
            if (source.sampler >= 0) {
                const auto& sampler = document_.model.samplers[static_cast<std::size_t>(source.sampler)];
                const std::string object =
                    object_name("sampler", static_cast<std::size_t>(source.sampler), sampler.name);
                texture.wrap_u = wrap(sampler.wrapS, object);
                texture.wrap_v = wrap(sampler.wrapT, object);
            }
            surfaces_.textures.push_back(texture);
        }
        return found->second;
    }

    Wrap wrap(int mode, const std::string& object) const {
        switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::kRepeat;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::kMirror;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::kClamp;
        default:
            document_.refuse(object, "unknown wrap mode " + std::to_string(mode) + "; expected 10497, 33071 or 33648");
        }
    }

    GltfDocument& document_;
    GltfSurfaces surfaces_;
    std::map<int, std::uint32_t> kept_;
};

} // namespace

GltfSurfaces read_surfaces(GltfDocument& document) {
    return SurfaceReader(document).read();
}

} // namespace fieldcast::scene
