// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/document.h"

#include "core/base/error.h"
#include "core/scene/uri.h"

#include <algorithm>
#include <exception>
#include <span>

namespace fieldcast::scene {

namespace {

using nlohmann::json;

std::string text_member(const json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? std::string() : found->get<std::string>();
}

/// Entries of a list; none if the object has no such member.
std::span<json> member_list(json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? std::span<json>() : std::span<json>(found->get_ref<json::array_t&>());
}

json take_member(json& object, const char* key) {
    json taken = json::array();
    if (const auto found = object.find(key); found != object.end()) {
        taken = std::move(*found);
        object.erase(found);
    }
    return taken;
}

/// Reads the document's files in the order in which the glTF file names them.
class DocumentReader {
public:
    DocumentReader(const std::filesystem::path& file, const LoadOptions& options)
        : files_(file, options.limits.max_file_bytes) {
        document_.name = files_.files().main;
        if (options.environment) {
            files_.read_environment(*options.environment);
        } else if (options.surroundings == Surroundings::kStudio) {
            files_.add_studio();
        }
    }

    GltfDocument read(bool with_model) {
        GltfJson parsed = parse_gltf_json(files_.files().main_bytes(), document_.name);
        const json buffers = take_member(parsed.root, "buffers");
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            document_.buffers.push_back(read_buffer(buffers[i], i, parsed.binary));
        }
        const json images = take_member(parsed.root, "images");
        for (std::size_t i = 0; i < images.size(); ++i) {
            document_.images.push_back(read_image(images[i], i));
        }
        if (with_model) {
            warn_of_extensions(parsed.root);
            parse_model(std::move(parsed.root));
        }
        document_.files = files_.take();
        return std::move(document_);
    }

private:
    struct Bytes {
        std::span<const std::byte> view;
        std::vector<std::byte> owned;
    };

    Bytes read_uri(const std::string& uri, const std::string& object) {
        if (!is_data_uri(uri)) {
            return {files_.read_uri(uri, object), {}};
        }
        Decoded<std::vector<std::byte>> decoded = decode_data_uri(uri);
        if (!decoded) {
            document_.refuse(object, decoded.error().message);
        }
        Bytes bytes{{}, std::move(*decoded)};
        bytes.view = bytes.owned; // moving the vector does not move its heap memory
        return bytes;
    }

    GltfBuffer read_buffer(const json& entry, std::size_t index, std::span<const std::byte> binary) {
        const std::string object = object_name("buffer", index, text_member(entry, "name"));
        const auto length = entry.find("byteLength");
        if (length == entry.end() || *length == 0) {
            document_.refuse(object, "has no byteLength; it must be at least 1");
        }
        GltfBuffer buffer{length->get<std::uint64_t>(), {}, {}};
        const json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
        if (entry.contains(fallback) && entry.at(fallback) == true) {
            return buffer;
        }
        const std::string uri = text_member(entry, "uri");
        if (uri.empty() && (index != 0 || binary.empty())) {
            document_.refuse(object, "has neither a URI nor a binary chunk; it needs one of them");
        }
        Bytes bytes = uri.empty() ? Bytes{binary, {}} : read_uri(uri, object);
        if (bytes.view.size() < buffer.byte_length) {
            document_.refuse(object, "claims " + std::to_string(buffer.byte_length) + " bytes but has " +
                                         std::to_string(bytes.view.size()));
        }
        buffer.bytes = bytes.view.first(buffer.byte_length);
        buffer.data_bytes = std::move(bytes.owned);
        return buffer;
    }

    GltfImage read_image(const json& entry, std::size_t index) {
        const std::string uri = text_member(entry, "uri");
        const std::string label = uri.empty() || is_data_uri(uri) ? text_member(entry, "name") : uri;
        GltfImage image{object_name("image", index, label), entry.value("bufferView", -1), {}, {}};
        if (uri.empty() == (image.buffer_view < 0)) {
            document_.refuse(image.name, "needs exactly one of a URI and a buffer view");
        }
        if (!uri.empty()) {
            Bytes bytes = read_uri(uri, image.name);
            image.bytes = bytes.view;
            image.data_bytes = std::move(bytes.owned);
        }
        return image;
    }

    void warn_of_extensions(const json& root) {
        for (const json& name : root.value("extensionsUsed", json::array())) {
            if (!is_supported_extension(name.get<std::string>())) {
                document_.warnings.add("extension " + name.get<std::string>().substr(0, 60) + " is ignored");
            }
        }
    }

    void parse_model(json root) {
        document_.skin_count = take_member(root, "skins").size();
        drop_channels_without_node(root);
        const std::vector<int> indices = take_indices(root);
        const std::string text = root.dump();
        root.clear();
        std::string error;
        std::string warning;
        bool is_loaded = false;
        try {
            is_loaded = tinygltf::TinyGLTF().LoadASCIIFromString(&document_.model, &error, &warning, text.data(),
                                                                 static_cast<unsigned>(text.size()), {});
        } catch (const std::exception& exception) {
            error += exception.what();
        }
        // tinygltf reports some missing properties, but continues without the object that lacks them.
        if (!is_loaded || !error.empty()) {
            std::replace(error.begin(), error.end(), '\n', ' ');
            document_.refuse("json", error.empty() ? "cannot be parsed as glTF 2.0" : error);
        }
        auto next = indices.begin();
        for (tinygltf::Mesh& mesh : document_.model.meshes) {
            for (tinygltf::Primitive& primitive : mesh.primitives) {
                primitive.indices = *next++;
            }
        }
        FC_ASSERT(next == indices.end(), "tinygltf reads all primitives or reports an error");
    }

    /// Removes the `indices` of all primitives and returns them in order; −1: none. tinygltf refuses indices whose
    /// accessor has no buffer view, but those of compressed primitives have none.
    static std::vector<int> take_indices(json& root) {
        std::vector<int> indices;
        for (json& mesh : member_list(root, "meshes")) {
            for (json& primitive : member_list(mesh, "primitives")) {
                indices.push_back(primitive.value("indices", -1));
                primitive.erase("indices");
            }
        }
        return indices;
    }

    /// Removes animation channels without target node. They are legal, but have no meaning without an extension.
    static void drop_channels_without_node(json& root) {
        if (!root.contains("animations")) {
            return;
        }
        for (json& animation : root["animations"]) {
            json& channels = animation["channels"];
            if (channels.is_null()) {
                channels = json::array();
            }
            const auto is_dropped = [](const json& channel) {
                const auto target = channel.find("target");
                return target == channel.end() || !target->is_object() || !target->contains("node");
            };
            channels.erase(std::remove_if(channels.begin(), channels.end(), is_dropped), channels.end());
        }
    }

    GltfDocument document_;
    SceneFileReader files_;
};

} // namespace

GltfDocument read_gltf_document(const std::filesystem::path& file, const LoadOptions& options) {
    GltfDocument document = DocumentReader(file, options).read(true);
    check_gltf_references(document);
    return document;
}

SceneFiles read_scene_files(const std::filesystem::path& file, const LoadOptions& options) {
    return DocumentReader(file, options).read(false).files;
}

} // namespace fieldcast::scene
