// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/gpu/device.h"
#include "core/lightfield/views.h"
#include "core/render/view_request.h"

#include <memory>

namespace fieldcast::render {

/// Where the pixels of one view came from, beside the source.
struct WarpCounts {
    std::uint32_t residual = 0; ///< from the residual layer
    std::uint32_t outside = 0;  ///< extended from around: beyond the border of the source
    std::uint32_t hidden = 0;   ///< extended from around: hidden in the source

    std::uint32_t extended() const { return outside + hidden; }
};

/// Makes views from the source's colour and inverse depth alone, without the scene: for every pixel the nearest surface
/// on its line through the source, else in the residual layer; what neither shows is extended from behind. Not
/// thread-safe.
class WarpRenderer {
public:
    explicit WarpRenderer(const gpu::Device& device);
    ~WarpRenderer();

    /// Takes planes kColour and kInverseDepth of a frame with one source, and its residual layer if it has one. Fails
    /// if they are not there, or do not fit the header.
    Decoded<void> upload(const SourceFrame& frame);

    /// Views in the order of `request.positions`. Their discard counts say how much was extended: out_of_frustum
    /// (WarpCounts::outside) and plane (WarpCounts::hidden).
    Views render(const ViewRequest& request);

    const std::vector<WarpCounts>& counts() const; ///< of each view of the last render()

    /// Which pixels of view `index` of the last render() neither the source nor the residual layer showed, row-major.
    std::vector<bool> hole_mask(std::size_t index) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::render
