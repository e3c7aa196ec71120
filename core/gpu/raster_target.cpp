// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/raster_target.h"

#include "core/gpu/image.h"

#include <utility>

namespace fieldcast::gpu {

/// One array image and a view of each of its layers.
struct RasterTarget::Image {
    explicit Image(VkDevice d) : device(d) {}
    Image(const Device& device, const RasterTargetDesc& desc, VkFormat format);
    ~Image();
    Image(Image&& other) noexcept
        : device(other.device), image(std::exchange(other.image, VK_NULL_HANDLE)),
          memory(std::exchange(other.memory, VK_NULL_HANDLE)), views(std::move(other.views)) {}
    Image& operator=(Image&&) = delete;

    VkDevice device;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::vector<VkImageView> views;
};

struct RasterTarget::Images {
    std::vector<Image> colours;
    std::vector<Image> depth; ///< one image
};

namespace {

VkImageAspectFlags aspect_of(VkFormat format) {
    return format == RasterTarget::kDepthFormat ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImage create_image(const Device& device, const RasterTargetDesc& desc, VkFormat format) {
    const VkImageUsageFlags usage = format == RasterTarget::kDepthFormat
                                        ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                        : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    return create_image(device, ImageDesc{.format = format,
                                          .width_px = desc.width_px,
                                          .height_px = desc.height_px,
                                          .layers = desc.layers,
                                          .usage = usage});
}

VkImageView create_view(VkDevice device, VkImage image, VkFormat format, std::uint32_t layer) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {aspect_of(format), 0, 1, layer, 1};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device, &info, nullptr, &view), "vkCreateImageView");
    return view;
}

} // namespace

RasterTarget::Image::Image(const Device& d, const RasterTargetDesc& desc, VkFormat format) : Image(d.handle()) {
    image = create_image(d, desc, format);
    memory = allocate_and_bind(d, image);
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        views.push_back(create_view(device, image, format, layer));
    }
}

RasterTarget::Image::~Image() {
    for (VkImageView view : views) {
        vkDestroyImageView(device, view, nullptr);
    }
    vkDestroyImage(device, image, nullptr);
    vkFreeMemory(device, memory, nullptr);
}

RasterTarget::RasterTarget(const Device& device, const RasterTargetDesc& desc)
    : images_(std::make_unique<Images>()), desc_(desc) {
    for (const VkFormat format : desc.colours) {
        images_->colours.emplace_back(device, desc, format);
    }
    images_->depth.emplace_back(device, desc, kDepthFormat);
}

RasterTarget::RasterTarget() = default;
RasterTarget::~RasterTarget() = default;
RasterTarget::RasterTarget(RasterTarget&& other) noexcept = default;
RasterTarget& RasterTarget::operator=(RasterTarget&& other) noexcept = default;

void RasterTarget::begin(CommandRecorder& recorder) const {
    for (std::size_t i = 0; i < desc_.colours.size(); ++i) {
        transition(recorder.commands(), images_->colours[i].image, {.to = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    }
    transition(recorder.commands(), images_->depth[0].image,
               {.to = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, .aspect = VK_IMAGE_ASPECT_DEPTH_BIT});
}

void RasterTarget::copy_to(CommandRecorder& recorder, std::size_t colour, const Buffer& buffer,
                           std::uint64_t offset_bytes, std::uint64_t layer_bytes, std::uint32_t layer_count) const {
    const VkImage image = images_->colours.at(colour).image;
    transition(recorder.commands(), image,
               {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    std::vector<VkBufferImageCopy> regions(layer_count);
    for (std::uint32_t layer = 0; layer < layer_count; ++layer) {
        regions[layer].bufferOffset = offset_bytes + layer * layer_bytes;
        regions[layer].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        regions[layer].imageExtent = {desc_.width_px, desc_.height_px, 1};
    }
    vkCmdCopyImageToBuffer(recorder.commands(), image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.handle(),
                           layer_count, regions.data());
}

VkImageView RasterTarget::colour_view(std::size_t colour, std::uint32_t layer) const {
    return images_->colours.at(colour).views.at(layer);
}

VkImageView RasterTarget::depth_view(std::uint32_t layer) const {
    return images_->depth[0].views.at(layer);
}

} // namespace fieldcast::gpu
