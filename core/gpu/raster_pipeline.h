// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/raster_target.h"

namespace fieldcast::gpu {

/// A vertex and a fragment shader, embedded in the binary.
struct RasterCode {
    KernelCode vertex;
    KernelCode fragment;
};

/// One vertex attribute; its location is its index in RasterPipelineDesc::vertex.
struct VertexMember {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t offset_bytes = 0;
};

/// Inputs and outputs of a graphics pipeline.
struct RasterPipelineDesc {
    KernelLayout layout; ///< of both shaders
    std::vector<VertexMember> vertex;
    std::uint32_t vertex_bytes = 0;
    std::vector<VkFormat> colours; ///< formats of the target's images
    std::uint32_t written = ~0U;   ///< bit i: image i is written; the others stay unchanged
    bool writes_depth = true;
};

/// A graphics pipeline for triangle lists without culling. The fragment of greater depth, which is nearer, is kept.
/// Flat fragment inputs come from the first vertex of a triangle.
class RasterPipeline {
public:
    /// Throws VulkanError, which names the fragment shader.
    RasterPipeline(const Device& device, const RasterCode& code, const RasterPipelineDesc& desc,
                   std::span<const Specialisation> specialisations = {});
    ~RasterPipeline();
    RasterPipeline(const RasterPipeline&) = delete;
    RasterPipeline& operator=(const RasterPipeline&) = delete;

    VkPipeline pipeline() const { return pipeline_; }
    VkPipelineLayout layout() const { return layout_; }
    std::uint32_t push_bytes() const { return push_bytes_; }

private:
    VkDevice device_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::uint32_t push_bytes_;
};

/// Draws into one layer of a target. The constructor begins rendering and clears the layer (colours to all ones, depth
/// to 0); the destructor ends rendering.
class RasterPass {
public:
    RasterPass(CommandRecorder& recorder, const RasterTarget& target, std::uint32_t layer);
    ~RasterPass();
    RasterPass(const RasterPass&) = delete;
    RasterPass& operator=(const RasterPass&) = delete;

    /// Binds a pipeline and its descriptor sets 0, 1, …
    void use(const RasterPipeline& pipeline, std::initializer_list<const BindingSet*> sets);
    /// Binds vertices, and indices of 32 bits.
    void use_triangles(const Buffer& vertices, const Buffer& indices);

    /// Sets the push constants of the pipeline in use; exactly its push_bytes.
    template <class Push> void push(const Push& values) { push_raw(std::as_bytes(std::span(&values, 1))); }
    /// Draws the triangles of `index_count` indices.
    void draw(std::uint32_t first_index, std::uint32_t index_count);

private:
    void push_raw(std::span<const std::byte> bytes);

    VkCommandBuffer commands_;
    const RasterPipeline* pipeline_ = nullptr;
};

} // namespace fieldcast::gpu
