// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"

namespace fieldcast::gpu {

/// Size and formats of a target.
struct RasterTargetDesc {
    std::uint32_t width_px = 1;
    std::uint32_t height_px = 1;
    std::uint32_t layers = 1;      ///< images of equal size, drawn one after the other
    std::vector<VkFormat> colours; ///< unsigned integer formats; one image for each
};

/// Render target of a RasterPass: colour images and a depth buffer, in which 0 is far and greater values are nearer.
///
///   target.begin(recorder);
///   { RasterPass pass(recorder, target, layer); pass.use(…); pass.draw(…); }  // for each layer
///   target.copy_to(recorder, 0, buffer, 0, layer_bytes, layer_count);
class RasterTarget {
public:
    static constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

    RasterTarget();
    /// Throws VulkanError if the device cannot have such images.
    RasterTarget(const Device& device, const RasterTargetDesc& desc);
    ~RasterTarget();
    RasterTarget(RasterTarget&& other) noexcept;
    RasterTarget& operator=(RasterTarget&& other) noexcept;

    const RasterTargetDesc& desc() const { return desc_; }

    /// Must be recorded before the first pass. Earlier contents are lost.
    void begin(CommandRecorder& recorder) const;

    /// Copies the first `layer_count` layers of image `colour` to `buffer` after the last pass. Rows are tightly
    /// packed, and layers start `layer_bytes` apart. Each image may be copied once; the next pass needs begin() again.
    /// The copy is visible to later commands after recorder.barrier().
    void copy_to(CommandRecorder& recorder, std::size_t colour, const Buffer& buffer, std::uint64_t offset_bytes,
                 std::uint64_t layer_bytes, std::uint32_t layer_count) const;

    VkImageView colour_view(std::size_t colour, std::uint32_t layer) const;
    VkImageView depth_view(std::uint32_t layer) const;

private:
    struct Image;
    struct Images;
    std::unique_ptr<Images> images_;
    RasterTargetDesc desc_;
};

} // namespace fieldcast::gpu
