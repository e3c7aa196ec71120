// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/raster_target.h"

namespace fieldcast::gpu {

/// A vertex and a fragment shader, embedded in the binary.
struct RasterCode {
    KernelCode vertex;
    KernelCode fragment;
};

/// A member of a vertex, at the location of its index.
struct VertexMember {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t offset_bytes = 0;
};

struct RasterPipelineDesc {
    KernelLayout layout; ///< for both shaders
    std::vector<VertexMember> vertex;
    std::uint32_t vertex_bytes = 0;
    std::vector<VkFormat> colours; ///< of the targets
    std::uint32_t written = ~0U;   ///< bit i: image i is written; the others keep what they hold
    bool writes_depth = true;
};

/// A graphics pipeline for lists of triangles, seen from both sides; what is nearer (of greater depth) stays. Flat
/// inputs of fragments are those of a triangle's first vertex.
class RasterPipeline {
public:
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

/// Draws into one layer of a target, from construction, which clears it (colours to all ones), until destruction.
class RasterPass {
public:
    RasterPass(Recorder& recorder, const RasterTarget& target, std::uint32_t layer);
    ~RasterPass();
    RasterPass(const RasterPass&) = delete;
    RasterPass& operator=(const RasterPass&) = delete;

    void use(const RasterPipeline& pipeline, std::initializer_list<const BindingSet*> sets);
    void use_triangles(const Buffer& vertices, const Buffer& indices); ///< indices are u32

    /// For the pipeline in use; exactly its push_bytes.
    template <class Push> void push(const Push& values) { push_raw(std::as_bytes(std::span(&values, 1))); }
    void draw(std::uint32_t first_index, std::uint32_t index_count);

private:
    void push_raw(std::span<const std::byte> bytes);

    VkCommandBuffer commands_;
    const RasterPipeline* pipeline_ = nullptr;
};

} // namespace fieldcast::gpu
