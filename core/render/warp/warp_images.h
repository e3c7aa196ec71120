// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/gpu/command_recorder.h"
#include "core/render/source/source_planes.h"
#include "shaders/shared/warp.h"

namespace fieldcast::render {

/// The images on the device that a WarpRenderer searches: the source with its guard band, and the views of the residual
/// layer, of which only some tiles are known.
class WarpImages {
public:
    explicit WarpImages(const gpu::Device& device);

    /// See WarpRenderer::upload. Blocks.
    Decoded<void> upload(const SourceFrame& frame);

    const FrameHeader& header() const { return header_; } ///< of the source, including the residual layer
    std::uint32_t image_count() const { return static_cast<std::uint32_t>(images_.size()); }
    const shared::WarpImage& image(std::size_t index) const { return images_[index]; }
    const gpu::Buffer& records() const { return records_; } ///< WarpImages of all images
    const gpu::BindingLayout& layout() const { return layout_; }
    const gpu::BindingSet& bindings() const { return set_; }

    /// Maps pixels of `target` and their inverse depth to pixels of image `index`.
    shared::WarpPath path(std::size_t index, const Camera& target) const;

private:
    /// Numbers of texels and blocks of all images.
    struct Room {
        std::uint32_t texels = 0;
        std::uint32_t blocks = 0;
        std::uint32_t coarse = 0;
    };
    Room place_images(const SourceFrame& frame);
    void reserve(const Room& room);
    void record_unpack(const Plane& colour, const Plane& inverse_depth, std::uint32_t tile_count);
    void record_links();
    void record_bounds();

    const gpu::Device& device_;
    gpu::CommandRecorder recorder_;
    gpu::BindingLayout layout_;
    gpu::Kernel unpack_;
    gpu::Kernel link_;
    gpu::Kernel bounds_;
    FrameHeader header_;
    std::vector<shared::WarpImage> images_;
    std::vector<Camera> cameras_; ///< cameras of the images
    gpu::Buffer records_;
    gpu::Buffer colour_;        ///< colour plane being unpacked
    gpu::Buffer inverse_depth_; ///< inverse depth plane being unpacked
    gpu::Buffer tiles_;
    Room reserved_;
    gpu::Buffer texels_;
    gpu::Buffer blocks_;
    gpu::Buffer coarse_;
    gpu::TexelView texels_view_;
    gpu::TexelView blocks_view_;
    gpu::TexelView coarse_view_;
    gpu::BindingSet set_;
};

} // namespace fieldcast::render
