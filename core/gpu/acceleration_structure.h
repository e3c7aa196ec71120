// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/buffer.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace fieldcast::gpu {

/// Geometry of a bottom level. A vertex starts with its position (three float32); a triangle has three u32 indices.
struct TriangleGeometry {
    std::uint64_t vertex_address = 0;
    std::uint32_t vertex_stride_bytes = 12;
    std::uint32_t vertex_count = 0;
    std::uint64_t index_address = 0;
    std::uint32_t triangle_count = 0;
    bool is_opaque = true; ///< false: candidates are reported to the shader (alpha test)
};

/// One placement of a bottom level in a top level.
struct TopLevelInstance {
    glm::mat4 world_from_object{1.0F};
    std::uint32_t custom_index = 0; ///< less than 2^24
    std::uint64_t bottom_level_address = 0;
    bool is_opaque = true; ///< false: candidates are reported even if the geometry is opaque
    std::uint8_t mask = 0xFF;
};

/// An acceleration structure for ray queries (VK_KHR_acceleration_structure). Only on devices with `has_ray_query`.
class AccelerationStructure {
public:
    AccelerationStructure() = default;
    ~AccelerationStructure();
    AccelerationStructure(AccelerationStructure&& other) noexcept;
    AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

    /// Builds a bottom level of one geometry (for fast traces) and waits. Throws VulkanError.
    static AccelerationStructure bottom_level(const Device& device, const TriangleGeometry& geometry);
    /// Builds a top level of `instances` and waits. Throws VulkanError.
    static AccelerationStructure top_level(const Device& device, std::span<const TopLevelInstance> instances);
    /// Builds this top level again and waits; at most as many instances as top_level() had. Throws VulkanError.
    void rebuild(const Device& device, std::span<const TopLevelInstance> instances);

    std::uint64_t address() const { return address_; }
    VkAccelerationStructureKHR handle() const { return structure_; }

private:
    const Device* device_ = nullptr;
    VkAccelerationStructureKHR structure_ = VK_NULL_HANDLE;
    Buffer storage_;
    Buffer scratch_;
    Buffer instances_;
    std::uint64_t address_ = 0;
    std::uint32_t capacity_ = 0;
};

} // namespace fieldcast::gpu
