// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/acceleration_structure.h"

#include "core/base/error.h"
#include "core/gpu/device_state.h"
#include "core/gpu/run_once.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace fieldcast::gpu {
namespace {

constexpr std::uint32_t kMaxCustomIndex = (1U << 24U) - 1;

/// One geometry and its build info. Not copyable: the info points to the geometry.
struct Build {
    VkAccelerationStructureGeometryKHR geometry{};
    VkAccelerationStructureBuildGeometryInfoKHR info{};

    explicit Build(VkAccelerationStructureTypeKHR type) {
        geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
        info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
        info.type = type;
        info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
        info.geometryCount = 1;
        info.pGeometries = &geometry;
    }
    Build(const Build&) = delete;
    Build& operator=(const Build&) = delete;
};

VkAccelerationStructureBuildSizesInfoKHR build_sizes(const Device& device, const Build& build, std::uint32_t count) {
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    device.state().acceleration.build_sizes(device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                            &build.info, &count, &sizes);
    return sizes;
}

VkAccelerationStructureKHR create_structure(const Device& device, const Buffer& storage, std::uint64_t size_bytes,
                                            VkAccelerationStructureTypeKHR type) {
    VkAccelerationStructureCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    info.buffer = storage.handle();
    info.size = size_bytes;
    info.type = type;
    VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
    check(device.state().acceleration.create(device.handle(), &info, nullptr, &structure),
          "vkCreateAccelerationStructureKHR");
    return structure;
}

std::uint64_t address_of(const Device& device, VkAccelerationStructureKHR structure) {
    VkAccelerationStructureDeviceAddressInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
    info.accelerationStructure = structure;
    return device.state().acceleration.address(device.handle(), &info);
}

/// Scratch memory of `size_bytes`, and as much more as aligning its start may take.
Buffer make_scratch(const Device& device, std::uint64_t size_bytes) {
    return Buffer(device, size_bytes + device.state().scratch_alignment);
}

void build_now(const Device& device, Build& build, const Buffer& scratch, std::uint32_t count) {
    const auto alignment = device.state().scratch_alignment;
    build.info.scratchData.deviceAddress = (scratch.address() + alignment - 1) / alignment * alignment;
    run_once(device, [&](VkCommandBuffer commands) {
        const VkAccelerationStructureBuildRangeInfoKHR range = {count, 0, 0, 0};
        const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
        device.state().acceleration.build(commands, 1, &build.info, &ranges);
    });
}

void describe_triangles(Build& build, const TriangleGeometry& geometry) {
    build.geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    build.geometry.flags =
        geometry.is_opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    auto& triangles = build.geometry.geometry.triangles;
    triangles.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    triangles.vertexData.deviceAddress = geometry.vertex_address;
    triangles.vertexStride = geometry.vertex_stride_bytes;
    triangles.maxVertex = std::max(geometry.vertex_count, 1U) - 1;
    triangles.indexType = VK_INDEX_TYPE_UINT32;
    triangles.indexData.deviceAddress = geometry.index_address;
}

void describe_instances(Build& build, const Buffer& instances) {
    build.geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    auto& data = build.geometry.geometry.instances;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    data.data.deviceAddress = instances.address();
}

VkAccelerationStructureInstanceKHR to_vulkan(const TopLevelInstance& instance) {
    FC_ASSERT(instance.custom_index <= kMaxCustomIndex, "custom index of an instance has 24 bits");
    VkAccelerationStructureInstanceKHR out{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            out.transform.matrix[row][column] = instance.world_from_object[column][row];
        }
    }
    out.instanceCustomIndex = instance.custom_index & kMaxCustomIndex;
    out.mask = instance.mask;
    out.flags = instance.is_opaque ? 0 : VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR & 0xFFU;
    out.accelerationStructureReference = instance.bottom_level_address;
    return out;
}

} // namespace

AccelerationStructure::~AccelerationStructure() {
    if (structure_ != VK_NULL_HANDLE) {
        device_->state().acceleration.destroy(device_->handle(), structure_, nullptr);
    }
}

AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept : AccelerationStructure() {
    *this = std::move(other);
}

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(structure_, other.structure_);
    std::swap(storage_, other.storage_);
    std::swap(scratch_, other.scratch_);
    std::swap(instances_, other.instances_);
    std::swap(address_, other.address_);
    std::swap(capacity_, other.capacity_);
    return *this;
}

AccelerationStructure AccelerationStructure::bottom_level(const Device& device, const TriangleGeometry& geometry) {
    FC_ASSERT(device.info().has_ray_query, "the device has no ray queries");
    constexpr auto kType = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    Build build(kType);
    describe_triangles(build, geometry);
    const auto sizes = build_sizes(device, build, geometry.triangle_count);

    AccelerationStructure result;
    result.device_ = &device;
    result.capacity_ = geometry.triangle_count;
    result.storage_ = Buffer(device, sizes.accelerationStructureSize);
    result.structure_ = create_structure(device, result.storage_, sizes.accelerationStructureSize, kType);
    result.address_ = address_of(device, result.structure_);
    build.info.dstAccelerationStructure = result.structure_;
    build_now(device, build, make_scratch(device, sizes.buildScratchSize), geometry.triangle_count);
    return result;
}

AccelerationStructure AccelerationStructure::top_level(const Device& device,
                                                       std::span<const TopLevelInstance> instances) {
    FC_ASSERT(device.info().has_ray_query, "the device has no ray queries");
    constexpr auto kType = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    AccelerationStructure result;
    result.device_ = &device;
    result.capacity_ = static_cast<std::uint32_t>(instances.size());
    result.instances_ = Buffer(device, instances.size() * sizeof(VkAccelerationStructureInstanceKHR));
    Build build(kType);
    describe_instances(build, result.instances_);
    const auto sizes = build_sizes(device, build, result.capacity_);
    result.storage_ = Buffer(device, sizes.accelerationStructureSize);
    result.scratch_ = make_scratch(device, sizes.buildScratchSize);
    result.structure_ = create_structure(device, result.storage_, sizes.accelerationStructureSize, kType);
    result.address_ = address_of(device, result.structure_);
    result.rebuild(device, instances);
    return result;
}

void AccelerationStructure::rebuild(const Device& device, std::span<const TopLevelInstance> instances) {
    FC_ASSERT(instances.size() <= capacity_, "more instances than the top level was made for");
    std::vector<VkAccelerationStructureInstanceKHR> converted(instances.size());
    std::ranges::transform(instances, converted.begin(), to_vulkan);
    write_buffer(device, instances_, std::as_bytes(std::span(converted)));
    Build build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR);
    describe_instances(build, instances_);
    build.info.dstAccelerationStructure = structure_;
    build_now(device, build, scratch_, static_cast<std::uint32_t>(instances.size()));
}

} // namespace fieldcast::gpu
