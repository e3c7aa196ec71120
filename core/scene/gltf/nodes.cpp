// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/nodes.h"

#include "core/scene/gltf/numbers.h"

#include <cmath>

namespace fieldcast::scene {

namespace {

class NodeReader {
public:
    explicit NodeReader(const GltfDocument& document)
        : document_(document), parents_(document.model.nodes.size(), -1) {}

    GltfNodes read() {
        find_parents();
        check_cycles();
        result_.scene_index.assign(parents_.size(), kNone);
        for (const int root : scene_roots()) {
            add_tree(root);
        }
        return std::move(result_);
    }

private:
    const tinygltf::Node& source(int index) const { return document_.model.nodes[static_cast<std::size_t>(index)]; }

    void find_parents() {
        for (std::size_t i = 0; i < parents_.size(); ++i) {
            for (const int child : document_.model.nodes[i].children) {
                int& parent = parents_[static_cast<std::size_t>(child)];
                if (parent != -1) {
                    document_.refuse(node_name(document_, child), "has two parents; a node may have only one");
                }
                parent = static_cast<int>(i);
            }
        }
    }

    /// Every node has at most one parent, so nodes that are not reached from a root form cycles.
    void check_cycles() const {
        std::vector<bool> is_reached(parents_.size(), false);
        std::vector<int> open;
        for (std::size_t i = 0; i < parents_.size(); ++i) {
            if (parents_[i] == -1) {
                open.push_back(static_cast<int>(i));
            }
        }
        while (!open.empty()) {
            const int node = open.back();
            open.pop_back();
            is_reached[static_cast<std::size_t>(node)] = true;
            open.insert(open.end(), source(node).children.begin(), source(node).children.end());
        }
        for (std::size_t i = 0; i < is_reached.size(); ++i) {
            if (!is_reached[i]) {
                document_.refuse(node_name(document_, static_cast<int>(i)),
                                 "is its own ancestor or below such a node; nodes must form trees");
            }
        }
    }

    /// Roots of the default scene, or of the first scene if the file names no default. Without scenes: all roots.
    std::vector<int> scene_roots() const {
        const tinygltf::Model& model = document_.model;
        if (!model.scenes.empty()) {
            const auto index = static_cast<std::size_t>(std::max(model.defaultScene, 0));
            for (const int root : model.scenes[index].nodes) {
                if (parents_[static_cast<std::size_t>(root)] != -1) {
                    document_.refuse(object_name("scene", index),
                                     node_name(document_, root) + " is not a root, because it has a parent");
                }
            }
            return model.scenes[index].nodes;
        }
        std::vector<int> roots;
        for (std::size_t i = 0; i < parents_.size(); ++i) {
            if (parents_[i] == -1) {
                roots.push_back(static_cast<int>(i));
            }
        }
        return roots;
    }

    /// Adds a tree depth first, children in their order. It is a loop, because files may nest deeper than the stack.
    void add_tree(int root) {
        std::vector<int> open{root};
        while (!open.empty()) {
            const int index = open.back();
            open.pop_back();
            if (result_.scene_index[static_cast<std::size_t>(index)] != kNone) {
                continue; // the scene names this root twice
            }
            result_.scene_index[static_cast<std::size_t>(index)] = static_cast<std::uint32_t>(result_.nodes.size());
            result_.file_index.push_back(index);
            result_.nodes.push_back(read_node(index));
            open.insert(open.end(), source(index).children.rbegin(), source(index).children.rend());
        }
    }

    Node read_node(int index) const {
        const tinygltf::Node& from = source(index);
        const std::string object = node_name(document_, index);
        const int parent = parents_[static_cast<std::size_t>(index)];
        Node node;
        node.name = from.name;
        node.parent = parent == -1 ? kNone : result_.scene_index[static_cast<std::size_t>(parent)];
        if (!from.matrix.empty()) {
            node.matrix = read_matrix(from.matrix, object);
            return node;
        }
        if (!from.translation.empty()) {
            node.translation =
                checked_vector<glm::vec3>(document_, from.translation, object + ": translation", kAnyNumber);
        }
        if (!from.scale.empty()) {
            node.scale = checked_vector<glm::vec3>(document_, from.scale, object + ": scale", kAnyNumber);
        }
        if (!from.rotation.empty()) {
            node.rotation = read_rotation(from.rotation, object + ": rotation");
        }
        return node;
    }

    glm::quat read_rotation(const std::vector<double>& values, const std::string& object) const {
        const auto xyzw = checked_vector<glm::vec4>(document_, values, object, {-2.0, 2.0});
        const float length = glm::length(xyzw);
        if (!(length > 1e-6F)) {
            document_.refuse(object, "is not a rotation: the quaternion's length must be above 1e-6");
        }
        return {xyzw.w / length, xyzw.x / length, xyzw.y / length, xyzw.z / length};
    }

    glm::mat4 read_matrix(const std::vector<double>& values, const std::string& object) const {
        if (values.size() != 16) {
            document_.refuse(object, "matrix needs 16 numbers");
        }
        glm::mat4 matrix;
        for (int i = 0; i < 16; ++i) {
            matrix[i / 4][i % 4] =
                checked_float(document_, values[static_cast<std::size_t>(i)], object + ": matrix", kAnyNumber);
        }
        constexpr float kTolerance = 1e-5F; // rounding in exporters
        for (int column = 0; column < 4; ++column) {
            if (std::abs(matrix[column].w - (column == 3 ? 1.0F : 0.0F)) > kTolerance) {
                document_.refuse(object, "matrix is not affine: its last row must be 0, 0, 0, 1");
            }
            matrix[column].w = column == 3 ? 1.0F : 0.0F;
        }
        return matrix;
    }

    const GltfDocument& document_;
    std::vector<int> parents_; // per node of the file
    GltfNodes result_;
};

} // namespace

GltfNodes read_nodes(const GltfDocument& document) {
    return NodeReader(document).read();
}

std::string node_name(const GltfDocument& document, int file_index) {
    const auto index = static_cast<std::size_t>(file_index);
    return object_name("node", index, document.model.nodes[index].name);
}

} // namespace fieldcast::scene
