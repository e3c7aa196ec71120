// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/bindings.h"
#include "core/gpu/kernel.h"
#include "core/scene/scene.h"
#include "core/scene/traversal.h"

#include <memory>

namespace fieldcast::scene {

struct AccelerationOptions {
    bool share_meshes = false; ///< BVH: one bottom level per mesh even where flattening would be faster
};

struct AccelerationStatistics {
    std::uint32_t bottom_levels = 0;
    std::uint64_t triangles = 0; ///< in the bottom levels
    std::uint64_t nodes = 0;     ///< 0 for ray query
    std::uint64_t device_bytes = 0;
    double build_ms = 0.0;
    double update_ms = 0.0; ///< of the last update()
};

/// What rays are traced against on the device, for one of the two traversals. `device` and `scene` must outlive it.
class Acceleration {
public:
    /// Builds all levels. Throws UserError naming the limit if the scene is too large for the device.
    Acceleration(const gpu::Device& device, const Scene& scene, const ScenePose& pose, Traversal traversal,
                 const AccelerationOptions& options = {});
    ~Acceleration();
    Acceleration(const Acceleration&) = delete;
    Acceleration& operator=(const Acceleration&) = delete;

    /// Moves the animated parts: rebuilds the top level only. Not while submitted work uses it; sets stay valid.
    void update(const ScenePose& pose);

    /// Writes kBindNodes, kBindLeafTriangles and kBindTopLevel, or kBindAcceleration.
    void bind(gpu::BindingSet& set) const;
    static std::vector<gpu::Binding> bindings(Traversal traversal);

    /// For every kernel that traces rays: constants 100 and 102 (shared/bvh.h).
    std::vector<gpu::Specialisation> specialisations() const;

    const AccelerationStatistics& statistics() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::scene
