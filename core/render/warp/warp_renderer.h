// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/gpu/device.h"
#include "core/lightfield/views.h"
#include "core/render/view_request.h"

#include <memory>

namespace fieldcast::render {

/// Pixels of one view that did not come from the source.
struct WarpCounts {
    std::uint32_t residual = 0; ///< taken from the residual layer
    std::uint32_t outside = 0;  ///< extended from neighbours: beyond the border of the source
    std::uint32_t hidden = 0;   ///< extended from neighbours: hidden in the source

    std::uint32_t extended() const { return outside + hidden; }
};

/// Renders views from the source's colour and inverse depth alone, without the scene. A pixel shows the nearest surface
/// on its line through the source, or else the residual layer. Pixels that neither covers are extended from the
/// background around them. Not thread-safe.
class WarpRenderer {
public:
    explicit WarpRenderer(const gpu::Device& device);
    ~WarpRenderer();

    /// Uploads the planes kColour and kInverseDepth of a frame with one source, and its residual layer if it has one.
    /// Fails if a plane is missing or does not match the header.
    Decoded<void> upload(const SourceFrame& frame);

    /// Views in the order of `request.positions`. Their discard counts give the extended pixels: out_of_frustum is
    /// WarpCounts::outside, plane is WarpCounts::hidden.
    Views render(const ViewRequest& request);

    const std::vector<WarpCounts>& counts() const; ///< of each view of the last render()

    /// Pixels of view `index` of the last render() that neither source nor residual layer covered, row-major.
    std::vector<bool> hole_mask(std::size_t index) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::render
