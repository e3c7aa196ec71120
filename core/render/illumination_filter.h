// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/svgf.h"

namespace fieldcast::render {

/// What happens between path tracing and packing: accumulation over time and the denoiser that the settings ask for.
class IlluminationFilter {
public:
    IlluminationFilter(const gpu::Device& device, const scene::GpuScene& scene);

    void resize(std::uint32_t texel_count) { accumulation_.resize(texel_count); } ///< pixels of all pages

    /// Where the path tracer writes its noisy illumination, and source_surfaces.comp the geometry of this frame.
    const gpu::Buffer& noisy_diffuse() const { return accumulation_.noisy().diffuse.buffer; }
    const gpu::Buffer& noisy_specular() const { return accumulation_.noisy().specular.buffer; }
    const gpu::Buffer& geometry() const { return accumulation_.now().geometry; }

    /// Records what the settings ask for. The result is in `diffuse()` and `specular()`.
    void record(gpu::Recorder& recorder, const FilterFrame& frame);
    const gpu::Buffer& diffuse() const { return result_->diffuse.buffer; }
    const gpu::Buffer& specular() const { return result_->specular.buffer; }

    /// This frame's data become the history of the next one.
    void swap() { accumulation_.swap(); }

private:
    Accumulation accumulation_;
    Svgf svgf_;
    const Light* result_ = nullptr;
};

} // namespace fieldcast::render
