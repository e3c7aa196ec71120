// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"

namespace fieldcast::gpu {

struct RasterTargetDesc {
    std::uint32_t width_px = 1;
    std::uint32_t height_px = 1;
    std::uint32_t layers = 1;      ///< equal-sized pictures, drawn one after the other
    std::vector<VkFormat> colours; ///< of unsigned integers; one image for each
};

/// Images that triangles are drawn into (RasterPass), with a depth buffer: 0 is far, greater is nearer.
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

    /// Before the first pass: what was drawn before is lost.
    void begin(Recorder& recorder) const;

    /// After the last pass: rows of the first `layer_count` layers of image `colour`, tightly packed, each layer
    /// `layer_bytes` after the one before. May be called for one image after another; then nothing more is drawn before
    /// begin(). Visible to later commands after recorder.barrier().
    void copy_to(Recorder& recorder, std::size_t colour, const Buffer& buffer, std::uint64_t offset_bytes,
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
