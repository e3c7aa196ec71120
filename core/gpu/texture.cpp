// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/texture.h"

#include "core/base/error.h"
#include "core/gpu/format.h"
#include "core/gpu/image.h"
#include "core/gpu/run_once.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace fieldcast::gpu {
namespace {

std::uint32_t mip_count(const TextureDesc& desc) {
    return desc.mip_maps ? static_cast<std::uint32_t>(std::bit_width(std::max(desc.width_px, desc.height_px))) : 1U;
}

void require_format(const Device& device, const TextureDesc& desc) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device.physical(), desc.format, &properties);
    VkFormatFeatureFlags wanted =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    if (desc.mip_maps) {
        wanted |= VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
    }
    if ((properties.optimalTilingFeatures & wanted) != wanted) {
        throw VulkanError("vkCreateImage: " + device.info().name + " cannot filter images of VkFormat " +
                          std::to_string(desc.format));
    }
}

VkImage create_image(const Device& device, const TextureDesc& desc) {
    return create_image(device, ImageDesc{.format = desc.format,
                                          .width_px = desc.width_px,
                                          .height_px = desc.height_px,
                                          .layers = desc.layers,
                                          .mips = mip_count(desc),
                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
}

VkImageView create_view(VkDevice device, VkImage image, const TextureDesc& desc) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    info.format = desc.format;
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, mip_count(desc), 0, desc.layers};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device, &info, nullptr, &view), "vkCreateImageView");
    return view;
}

VkSampler create_sampler(VkDevice device) {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.maxLod = VK_LOD_CLAMP_NONE;
    VkSampler sampler = VK_NULL_HANDLE;
    check(vkCreateSampler(device, &info, nullptr, &sampler), "vkCreateSampler");
    return sampler;
}

VkOffset3D mip_corner(const TextureDesc& desc, std::uint32_t mip) {
    return {static_cast<std::int32_t>(std::max(desc.width_px >> mip, 1U)),
            static_cast<std::int32_t>(std::max(desc.height_px >> mip, 1U)), 1};
}

/// Makes each mip level from the level before. A linear blit to half the size averages 2×2 texels where sizes are even,
/// in linear light for sRGB formats.
void make_mips(VkCommandBuffer commands, VkImage image, const TextureDesc& desc) {
    for (std::uint32_t mip = 1; mip < mip_count(desc); ++mip) {
        transition(commands, image,
                   {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, mip - 1, 1});
        VkImageBlit blit{};
        blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, desc.layers};
        blit.srcOffsets[1] = mip_corner(desc, mip - 1);
        blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, desc.layers};
        blit.dstOffsets[1] = mip_corner(desc, mip);
        vkCmdBlitImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
        transition(commands, image,
                   {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, mip - 1, 1});
    }
    transition(
        commands, image,
        {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, mip_count(desc) - 1, 1});
}

/// Uploads layer by layer, so that the staging buffer needs the memory of one layer only.
void upload(const Device& device, VkImage image, const TextureDesc& desc,
            std::span<const std::span<const std::byte>> layer_bytes) {
    const Buffer staging(device, layer_bytes[0].size(), Memory::kUpload);
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        write_buffer(device, staging, layer_bytes[layer]);
        run_once(device, [&](VkCommandBuffer commands) {
            if (layer == 0) {
                transition(commands, image, {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL});
            }
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
            region.imageExtent = {desc.width_px, desc.height_px, 1};
            vkCmdCopyBufferToImage(commands, staging.handle(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
    }
    run_once(device, [&](VkCommandBuffer commands) { make_mips(commands, image, desc); });
}

} // namespace

Texture::Texture(const Device& device, const TextureDesc& desc, std::span<const std::span<const std::byte>> layer_bytes)
    : Texture() {
    const auto bytes = std::size_t{desc.width_px} * desc.height_px * texel_bytes(desc.format);
    FC_ASSERT(bytes > 0 && desc.layers > 0 && layer_bytes.size() == desc.layers, "one span per layer");
    FC_ASSERT(std::ranges::all_of(layer_bytes, [&](const auto& layer) { return layer.size() == bytes; }),
              "a layer is not width x height texels");
    require_format(device, desc);
    device_ = device.handle();
    image_ = create_image(device, desc);
    memory_ = allocate_and_bind(device, image_);
    view_ = create_view(device_, image_, desc);
    sampler_ = create_sampler(device_);
    upload(device, image_, desc, layer_bytes);
}

Texture::~Texture() {
    release();
}

Texture::Texture(Texture&& other) noexcept : Texture() {
    *this = std::move(other);
}

Texture& Texture::operator=(Texture&& other) noexcept {
    if (this != &other) {
        release();
        device_ = std::exchange(other.device_, VK_NULL_HANDLE);
        image_ = std::exchange(other.image_, VK_NULL_HANDLE);
        memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
        view_ = std::exchange(other.view_, VK_NULL_HANDLE);
        sampler_ = std::exchange(other.sampler_, VK_NULL_HANDLE);
    }
    return *this;
}

void Texture::release() noexcept {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroySampler(device_, sampler_, nullptr);
        vkDestroyImageView(device_, view_, nullptr);
        vkDestroyImage(device_, image_, nullptr);
        vkFreeMemory(device_, memory_, nullptr);
    }
}

} // namespace fieldcast::gpu
