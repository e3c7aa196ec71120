// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/raster_pipeline.h"

#include "core/base/error.h"
#include "core/gpu/shader_stage.h"

#include <array>

namespace fieldcast::gpu {
namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

/// Fixed-function state of a graphics pipeline. Not copyable: its members point to each other.
struct FixedFunctions {
    VkVertexInputBindingDescription binding{};
    std::vector<VkVertexInputAttributeDescription> members;
    VkPipelineVertexInputStateCreateInfo vertices{};
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    VkPipelineViewportStateCreateInfo viewport{};
    VkPipelineRasterizationStateCreateInfo rasterization{};
    VkPipelineMultisampleStateCreateInfo samples{};
    VkPipelineDepthStencilStateCreateInfo depth{};
    std::array<VkDynamicState, 2> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};

    explicit FixedFunctions(const RasterPipelineDesc& desc) {
        binding = {0, desc.vertex_bytes, VK_VERTEX_INPUT_RATE_VERTEX};
        for (std::uint32_t i = 0; i < desc.vertex.size(); ++i) {
            members.push_back({i, 0, desc.vertex[i].format, desc.vertex[i].offset_bytes});
        }
        vertices.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
        vertices.vertexBindingDescriptionCount = 1;
        vertices.pVertexBindingDescriptions = &binding;
        vertices.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(members.size());
        vertices.pVertexAttributeDescriptions = members.data();
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        viewport.viewportCount = 1;
        viewport.scissorCount = 1;
        rasterization.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        rasterization.polygonMode = VK_POLYGON_MODE_FILL;
        rasterization.cullMode = VK_CULL_MODE_NONE;
        rasterization.lineWidth = 1.0F;
        samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
        depth.depthTestEnable = VK_TRUE;
        depth.depthWriteEnable = desc.writes_depth ? VK_TRUE : VK_FALSE;
        depth.depthCompareOp = VK_COMPARE_OP_GREATER;
        dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
        dynamic.pDynamicStates = dynamic_states.data();
    }
    FixedFunctions(const FixedFunctions&) = delete;
    FixedFunctions& operator=(const FixedFunctions&) = delete;
};

std::vector<VkPipelineColorBlendAttachmentState> write_masks(const RasterPipelineDesc& desc) {
    std::vector<VkPipelineColorBlendAttachmentState> masks(desc.colours.size());
    for (std::size_t i = 0; i < masks.size(); ++i) {
        constexpr VkColorComponentFlags kAll =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
        masks[i].colorWriteMask = (desc.written >> i & 1U) != 0 ? kAll : 0;
    }
    return masks;
}

VkPipeline create_pipeline(const Device& device, const RasterCode& code, const RasterPipelineDesc& desc,
                           VkPipelineLayout layout, std::span<const Specialisation> specialisations) {
    const SpecialisationMap special(specialisations);
    const ShaderModule vertex(device, code.vertex);
    const ShaderModule fragment(device, code.fragment);
    const std::array stages = {vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, special),
                               fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT, special)};
    const FixedFunctions fixed(desc);
    const auto masks = write_masks(desc);
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = static_cast<std::uint32_t>(masks.size());
    blend.pAttachments = masks.data();
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(desc.colours.size());
    rendering.pColorAttachmentFormats = desc.colours.data();
    rendering.depthAttachmentFormat = RasterTarget::kDepthFormat;

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &fixed.vertices;
    info.pInputAssemblyState = &fixed.assembly;
    info.pViewportState = &fixed.viewport;
    info.pRasterizationState = &fixed.rasterization;
    info.pMultisampleState = &fixed.samples;
    info.pDepthStencilState = &fixed.depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &fixed.dynamic;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          (std::string("vkCreateGraphicsPipelines (") + code.fragment.name + ")").c_str());
    return pipeline;
}

} // namespace

RasterPipeline::RasterPipeline(const Device& device, const RasterCode& code, const RasterPipelineDesc& desc,
                               std::span<const Specialisation> specialisations)
    : device_(device.handle()), push_bytes_(desc.layout.push_bytes) {
    layout_ = create_pipeline_layout(device, desc.layout, kStages);
    try {
        pipeline_ = create_pipeline(device, code, desc, layout_, specialisations);
    } catch (...) {
        vkDestroyPipelineLayout(device_, layout_, nullptr);
        throw;
    }
}

RasterPipeline::~RasterPipeline() {
    vkDestroyPipeline(device_, pipeline_, nullptr);
    vkDestroyPipelineLayout(device_, layout_, nullptr);
}

RasterPass::RasterPass(CommandRecorder& recorder, const RasterTarget& target, std::uint32_t layer)
    : commands_(recorder.commands()) {
    const RasterTargetDesc& desc = target.desc();
    std::vector<VkRenderingAttachmentInfo> colours(desc.colours.size());
    for (std::size_t i = 0; i < colours.size(); ++i) {
        colours[i].sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        colours[i].imageView = target.colour_view(i, layer);
        colours[i].imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        colours[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        colours[i].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        std::ranges::fill(colours[i].clearValue.color.uint32, ~0U);
    }
    VkRenderingAttachmentInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    depth.imageView = target.depth_view(layer);
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkRect2D area = {{0, 0}, {desc.width_px, desc.height_px}};
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = area;
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(colours.size());
    info.pColorAttachments = colours.data();
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands_, &info);
    const VkViewport viewport = {0, 0, static_cast<float>(desc.width_px), static_cast<float>(desc.height_px), 0, 1};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &area);
}

RasterPass::~RasterPass() {
    vkCmdEndRendering(commands_);
}

void RasterPass::use(const RasterPipeline& pipeline, std::initializer_list<const BindingSet*> sets) {
    pipeline_ = &pipeline;
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline());
    std::uint32_t index = 0;
    for (const BindingSet* set : sets) {
        const VkDescriptorSet handle = set->handle();
        vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout(), index++, 1, &handle, 0,
                                nullptr);
    }
}

void RasterPass::use_triangles(const Buffer& vertices, const Buffer& indices) {
    const VkBuffer handle = vertices.handle();
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(commands_, 0, 1, &handle, &offset);
    vkCmdBindIndexBuffer(commands_, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
}

void RasterPass::push_raw(std::span<const std::byte> bytes) {
    FC_ASSERT(pipeline_ != nullptr && bytes.size() == pipeline_->push_bytes(),
              "push constants differ in size from what the pipeline declares");
    vkCmdPushConstants(commands_, pipeline_->layout(), kStages, 0, static_cast<std::uint32_t>(bytes.size()),
                       bytes.data());
}

void RasterPass::draw(std::uint32_t first_index, std::uint32_t index_count) {
    vkCmdDrawIndexed(commands_, index_count, 1, first_index, 0, 0);
}

} // namespace fieldcast::gpu
