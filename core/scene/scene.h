// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::scene {

inline constexpr std::uint32_t kMaxInstances = 1U << 20;
inline constexpr std::uint32_t kMaxMaterials = 4096;
inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;

/// Decoded image, 8 bits per channel, RGBA, row 0 on top.
struct Image {
    std::string name; ///< file name or "image 3", for messages
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<std::uint8_t> rgba;
};

enum class Wrap : std::uint8_t { kRepeat = 0, kMirror = 1, kClamp = 2 };

/// An image with its wrap modes. glTF magnification filters are ignored: always linear with mip maps.
struct Texture {
    std::uint32_t image = 0;
    Wrap wrap_u = Wrap::kRepeat;
    Wrap wrap_v = Wrap::kRepeat;
};

/// Use of a texture in a material. Its coordinates are uv' = uv_matrix · (u, v, 1), where the matrix has two rows.
struct TextureUse {
    std::uint32_t texture = kNone; ///< index into Scene::textures
    std::uint32_t uv_set = 0;      ///< 0 or 1
    std::array<glm::vec3, 2> uv_matrix{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
};

enum class AlphaMode : std::uint8_t { kOpaque = 0, kMask = 1, kBlend = 2 };

/// glTF metallic-roughness with the extensions listed in docs/scenes.md.
struct Material {
    std::string name;
    TextureUse base_colour;        ///< sRGB; alpha in A
    TextureUse metallic_roughness; ///< linear; roughness in G, metallic in B
    TextureUse normal;             ///< linear, tangent space
    TextureUse emissive;           ///< sRGB
    glm::vec4 base_colour_factor{1.0F};
    glm::vec3 emissive_factor{0.0F}; ///< × KHR_materials_emissive_strength
    float metallic_factor = 1.0F;
    float roughness_factor = 1.0F;
    float normal_scale = 1.0F;
    float ior = 1.5F;
    float transmission_factor = 0.0F; ///< thin wall
    TextureUse transmission;          ///< linear, R
    AlphaMode alpha_mode = AlphaMode::kOpaque;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;
};

/// One glTF primitive: an indexed triangle list. Attribute arrays are empty or as long as `positions`.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions; ///< metres, object space
    std::vector<glm::vec3> normals;   ///< unit length; always present (flat normals if the file has none)
    std::vector<glm::vec4> tangents;  ///< xyz unit, w = ±1; may be empty
    std::vector<glm::vec2> uv0;
    std::vector<glm::vec2> uv1;
    std::vector<glm::vec4> colours; ///< linear RGBA, multiplies base colour
    std::vector<glm::uvec3> triangles;
    std::uint32_t material = 0;
};

/// Local transform of a node; a node given by matrix is decomposed, or keeps `matrix` if it has shear.
struct Node {
    std::string name;
    std::uint32_t parent = kNone; ///< always smaller than the node's own index
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix; ///< replaces TRS; such nodes cannot be animated (as in glTF)
    bool is_animated = false;        ///< this node or an ancestor has an animation channel
};

/// A mesh placed by a node. Visibility and wire ids store the index into Scene::instances.
struct Instance {
    std::uint32_t node = 0;
    std::uint32_t mesh = 0;
};

enum class LightType : std::uint8_t { kDirectional = 0, kPoint = 1, kSpot = 2 };

/// KHR_lights_punctual; intensities are radiometric, unscaled. Lights shine along −Z of their node.
struct Light {
    std::string name;
    LightType type = LightType::kDirectional;
    std::uint32_t node = 0;
    glm::vec3 intensity{1.0F}; ///< colour × intensity; W/m² (directional) or W/sr
    float range_m = std::numeric_limits<float>::infinity();
    float inner_cone_rad = 0.0F; ///< half angles of the cone
    float outer_cone_rad = 0.785398F;
    float angular_radius_rad = 0.0F; ///< directional: 0.2665° unless extras.angular_radius_deg says otherwise
};

/// A perspective camera of the file, or one that add_camera() added.
struct CameraNode {
    std::string name; ///< name of the node
    std::uint32_t node = 0;
    float fovy_rad = 0.785398F;
    std::optional<float> spacing_m; ///< node extras.fieldcast.spacing_m: recommended spacing of the lattice
};

enum class AnimationPath : std::uint8_t { kTranslation, kRotation, kScale };
enum class Interpolation : std::uint8_t { kStep, kLinear, kCubic };

/// One glTF animation channel with its sampler. `values` holds one vec4 per key (three for cubic:
/// in-tangent, value, out-tangent); rotations are quaternions xyzw.
struct AnimationChannel {
    std::uint32_t node = 0;
    AnimationPath path = AnimationPath::kTranslation;
    Interpolation interpolation = Interpolation::kLinear;
    std::vector<float> times_s; ///< strictly increasing
    std::vector<glm::vec4> values;
};

/// Equirectangular environment, or a constant sky when `pixels` is empty.
struct Environment {
    glm::vec3 constant{0.5F, 0.7F, 1.0F};
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<glm::vec3> pixels; ///< linear Rec. 709; −Z at u = 0.5, +Y at v = 0
};

/// 32 bytes of SHA-256 over the canonical bundle (see scene/bundle.h).
using SceneHash = std::array<std::uint8_t, 32>;

/// A loaded scene: plain data on the CPU, validated (all indices in range, all numbers finite).
struct Scene {
    std::string name; ///< file name without folder
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::vector<Material> materials; ///< never empty
    std::vector<Mesh> meshes;
    std::vector<Node> nodes; ///< parents before children
    std::vector<Instance> instances;
    std::vector<Light> lights;
    std::vector<CameraNode> cameras;
    std::vector<AnimationChannel> channels;
    double duration_s = 0.0; ///< duration of the longest animation; 0: no animation
    Environment environment;
    bool has_studio = false; ///< `environment` is the studio (core/scene/studio.h)
    SceneHash hash{};
    std::vector<std::string> warnings; ///< one per kind and file ("skins are ignored (3 nodes)")
};

/// World transforms of all nodes at one moment. All animations play together, looped over `duration_s`.
struct ScenePose {
    std::int64_t time_ns = 0;
    std::vector<glm::mat4> world_from_node;
};

ScenePose pose_scene(const Scene& scene, std::int64_t time_ns);

/// Number of times the animations have restarted by `time_ns`. If it differs between two frames, the second is a cut.
/// The end of a loop belongs to the loop: the last keys are shown at time `duration_s`.
std::int64_t loop_index(const Scene& scene, std::int64_t time_ns);

/// The camera called `name`. Without a name: the camera "LightField", else the first one. Null if there is none.
const CameraNode* find_camera(const Scene& scene, const std::string& name = {});

/// Rigid camera pose: the node's world transform without scale.
glm::mat4 camera_pose(const ScenePose& pose, const CameraNode& camera);

} // namespace fieldcast::scene
