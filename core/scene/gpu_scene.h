// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/kernel.h"
#include "core/scene/draw_geometry.h"
#include "core/scene/traversal.h"
#include "core/scene/visibility_method.h"

#include <memory>

namespace fieldcast::scene {

/// A scene on a Vulkan device: descriptor set 0 of every kernel that looks at surfaces (shaders/shared/scene.h).
/// `scene` must outlive it. Unless it is said how, views are made visible as choose_visibility() does for "auto".
class GpuScene {
public:
    GpuScene(const gpu::Device& device, const Scene& scene, Traversal traversal);
    GpuScene(const gpu::Device& device, const Scene& scene, Traversal traversal, VisibilityMethod visibility);
    ~GpuScene();
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    /// Places everything as it is at `time_ns`. The pose before becomes the previous pose (motion of surfaces);
    /// with `cut` there is no motion. Not while submitted work uses the scene.
    void pose(std::int64_t time_ns, bool cut);

    /// Calls of pose() so far: who keeps a history can tell whether it is of the pose before.
    std::uint64_t pose_count() const;

    const ScenePose& current_pose() const;
    const Scene& scene() const;
    Traversal traversal() const;
    float radius_m() const; ///< of the sphere around everything, as placed when loaded
    VisibilityMethod visibility() const;
    const DrawGeometry* draw_geometry() const; ///< null: views are always traced
    const gpu::BindingLayout& layout() const;
    const gpu::BindingSet& bindings() const;
    bool has_blend() const;  ///< some material is BLEND
    bool has_glossy() const; ///< some surface may be smoother than kGlossyRoughness
    /// For every kernel that includes lib/scene_data.glsl.
    std::vector<gpu::Specialisation> specialisations() const;
    std::uint64_t device_bytes() const; ///< of all buffers and textures

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::scene
