// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/animations.h"

#include <algorithm>
#include <optional>
#include <set>

namespace fieldcast::scene {

namespace {

/// Limit over all channels. A limit on the file's size is not enough, because channels may share the same bytes.
constexpr std::uint64_t kMaxKeys = 1ULL << 24;
constexpr float kMaxTime_s = 1e6F; ///< 11.6 days; floats of this size are 1/16 s apart

class AnimationReader {
public:
    AnimationReader(GltfDocument& document, GltfAccessors& accessors, GltfNodes& nodes)
        : document_(document), accessors_(accessors), nodes_(nodes) {}

    std::vector<AnimationChannel> read() {
        const auto& animations = document_.model.animations;
        for (std::size_t i = 0; i < animations.size(); ++i) {
            for (const tinygltf::AnimationChannel& channel : animations[i].channels) {
                add_channel(animations[i], channel, object_name("animation", i, animations[i].name));
            }
        }
        mark_animated();
        return std::move(channels_);
    }

private:
    void add_channel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& source,
                     const std::string& object) {
        if (source.target_path == "weights") {
            document_.warnings.add("morph target animations are ignored", "channel");
            return;
        }
        const std::uint32_t node = nodes_.scene_index[static_cast<std::size_t>(source.target_node)];
        if (node == kNone) {
            return; // the node is not part of the scene
        }
        const std::string target = object + ": " + node_name(document_, source.target_node);
        if (nodes_.nodes[node].matrix) {
            document_.refuse(target, "a node with a matrix cannot be animated; use translation, rotation and scale");
        }
        AnimationChannel channel;
        channel.node = node;
        channel.path = path_of(source.target_path, target);
        if (!targets_.emplace(node, channel.path).second) {
            document_.warnings.add("several animations move the same node; the last one is used", "channel");
        }
        read_keys(animation.samplers[static_cast<std::size_t>(source.sampler)], target, channel);
        channels_.push_back(std::move(channel));
    }

    AnimationPath path_of(const std::string& path, const std::string& object) const {
        if (path == "translation") {
            return AnimationPath::kTranslation;
        }
        if (path != "rotation" && path != "scale") {
            document_.refuse(object, "unknown path '" + path.substr(0, 20) +
                                         "'; expected translation, rotation, scale or weights");
        }
        return path == "rotation" ? AnimationPath::kRotation : AnimationPath::kScale;
    }

    Interpolation interpolation_of(const std::string& name, const std::string& object) const {
        if (name == "LINEAR") {
            return Interpolation::kLinear;
        }
        if (name != "STEP" && name != "CUBICSPLINE") {
            document_.refuse(object, "unknown interpolation '" + name.substr(0, 20) +
                                         "'; expected LINEAR, STEP or CUBICSPLINE");
        }
        return name == "STEP" ? Interpolation::kStep : Interpolation::kCubic;
    }

    void read_keys(const tinygltf::AnimationSampler& sampler, const std::string& object, AnimationChannel& channel) {
        channel.interpolation = interpolation_of(sampler.interpolation, object);
        const std::uint64_t values_per_key = channel.interpolation == Interpolation::kCubic ? 3 : 1;
        if (accessors_.count(sampler.output) != accessors_.count(sampler.input) * values_per_key) {
            document_.refuse(object, "needs as many values as times, with CUBICSPLINE three times as many");
        }
        key_count_ += accessors_.count(sampler.output);
        if (key_count_ > kMaxKeys) {
            document_.refuse(object, "brings the file to more than " + std::to_string(kMaxKeys) +
                                         " animation values, the limit; use fewer keys");
        }
        channel.times_s = accessors_.read_floats(sampler.input, 1, object + ": times");
        if (channel.times_s.front() < 0.0F || std::adjacent_find(channel.times_s.begin(), channel.times_s.end(),
                                                                 std::greater_equal<>()) != channel.times_s.end()) {
            document_.refuse(object, "times are negative or not increasing; each must be greater than the one before");
        }
        if (channel.times_s.back() > kMaxTime_s) {
            document_.refuse(object, "lasts longer than " + std::to_string(static_cast<int>(kMaxTime_s)) +
                                         " s, the limit; make the animation shorter");
        }
        if (channel.path == AnimationPath::kRotation) {
            channel.values = accessors_.read_vectors<4>(sampler.output, object + ": values");
            normalise_rotations(channel, values_per_key, object);
            return;
        }
        for (const glm::vec3& value : accessors_.read_vectors<3>(sampler.output, object + ": values")) {
            channel.values.emplace_back(value, 0.0F);
        }
    }

    /// Of the three values of a cubic key only the middle one is a rotation; the others are tangents.
    void normalise_rotations(AnimationChannel& channel, std::uint64_t values_per_key, const std::string& object) const {
        for (std::size_t i = values_per_key / 2; i < channel.values.size(); i += values_per_key) {
            const float length = glm::length(channel.values[i]);
            if (!(length > 1e-6F && length < 1e6F)) {
                document_.refuse(object, "value " + std::to_string(i) +
                                             " is not a rotation: its length must be between 1e-6 and 1e6");
            }
            channel.values[i] /= length;
        }
    }

    void mark_animated() {
        for (const AnimationChannel& channel : channels_) {
            nodes_.nodes[channel.node].is_animated = true;
        }
        for (Node& node : nodes_.nodes) { // parents come first
            node.is_animated = node.is_animated || (node.parent != kNone && nodes_.nodes[node.parent].is_animated);
        }
    }

    GltfDocument& document_;
    GltfAccessors& accessors_;
    GltfNodes& nodes_;
    std::vector<AnimationChannel> channels_;
    std::set<std::pair<std::uint32_t, AnimationPath>> targets_;
    std::uint64_t key_count_ = 0;
};

} // namespace

std::vector<AnimationChannel> read_animations(GltfDocument& document, GltfAccessors& accessors, GltfNodes& nodes) {
    return AnimationReader(document, accessors, nodes).read();
}

} // namespace fieldcast::scene
