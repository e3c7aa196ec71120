// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/gpu/readback.h"
#include "core/lightfield/source_frame.h"
#include "core/lightfield/vocabulary.h"

#include <array>
#include <span>

namespace fieldcast::render {

/// All planes of a SourceFrame, in the order of their semantics.
inline constexpr std::array kSourceSemantics{PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular,
                                             PlaneSemantic::kDepth,   PlaneSemantic::kNormal,
                                             PlaneSemantic::kId,      PlaneSemantic::kMaterial};

/// A SourceFrame on the device, in wire precision. Server and clients make views from it. One 32-bit word per pixel and
/// plane (kMaterial: in the low 16 bits). Every plane has all pages (lightfield's page_count()), one after the other.
/// G-buffer pages of layers are not sent, because a client with the scene can make them.
class SourcePlanes {
public:
    explicit SourcePlanes(const gpu::Device& device);

    /// Allocates the planes of `header` and keeps the header. The contents are undefined afterwards. Throws
    /// VulkanError.
    void resize(const FrameHeader& header);

    /// Copies planes to the host, all in one submission (the wire's SourceFrame). Blocks. Not by several threads at
    /// once: they would share the staging buffer.
    SourceFrame download(std::span<const PlaneSemantic> wanted) const;

    /// Uploads the planes of `frame`; planes that it lacks stay undefined. Fails if a plane has a wrong size or format.
    /// Normals may be kOct2x8. kTotalLight becomes both kDiffuse and kSpecular.
    Decoded<bool> upload(const SourceFrame& frame);

    const FrameHeader& header() const { return header_; }
    /// Of source image `index`, guard band included; all have one size.
    Camera camera(std::size_t index = 0) const { return widened_source(header_, index); }
    std::uint32_t source_count() const { return static_cast<std::uint32_t>(header_.source_positions.size()); }
    std::uint32_t page_count() const { return source_count() * (1 + header_.layer_count); }
    std::uint32_t pixel_count() const { return pixel_count_; } ///< of one page
    std::uint32_t texel_count() const { return pixel_count_ * page_count(); }
    const gpu::Buffer& plane(PlaneSemantic semantic) const;

private:
    const gpu::Device& device_;
    FrameHeader header_;
    std::uint32_t pixel_count_ = 0;
    std::uint32_t allocated_texels_ = 0;
    std::array<gpu::Buffer, kSourceSemantics.size()> planes_;
    mutable gpu::Readback readback_;
};

} // namespace fieldcast::render
