// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/bmfr.h"
#include "core/render/denoise/punctual_filter.h"
#include "core/render/denoise/svgf.h"

namespace fieldcast::render {

/// The passes between path tracing and packing: accumulation over time, then the denoiser chosen by the settings.
class IlluminationFilter {
public:
    IlluminationFilter(const gpu::Device& device, const scene::GpuScene& scene);

    /// `texel_count`: pixels of all pages. `is_punctual_apart`: the path tracer writes direct diffuse light of punctual
    /// lights to `noisy_punctual()`; only for SVGF+.
    void resize(std::uint32_t texel_count, bool is_punctual_apart = false) {
        accumulation_.resize(texel_count, is_punctual_apart);
    }

    /// Targets of this frame: the path tracer writes noisy illumination, source_surfaces.comp writes the geometry.
    const gpu::Buffer& noisy_diffuse() const { return accumulation_.noisy().diffuse.buffer; }
    const gpu::Buffer& noisy_specular() const { return accumulation_.noisy().specular.buffer; }
    const gpu::Buffer& noisy_punctual() const { return accumulation_.noisy_punctual().buffer; }
    const gpu::Buffer& geometry() const { return accumulation_.now().geometry; }
    const gpu::Buffer& previous_geometry() const { return accumulation_.before().geometry; }

    /// Records the passes that the settings choose. The result is in `diffuse()` and `specular()`.
    void record(gpu::CommandRecorder& recorder, const FilterFrame& frame);
    const gpu::Buffer& diffuse() const { return result_->diffuse.buffer; }
    const gpu::Buffer& specular() const { return result_->specular.buffer; }

    /// Illumination that the caller adds to `diffuse()`; null: none.
    const gpu::Buffer* punctual() const { return punctual_result_; }

    /// Makes this frame's data the history of the next frame.
    void swap() { accumulation_.swap(); }

private:
    Accumulation accumulation_;
    Svgf svgf_;
    Bmfr bmfr_;
    PunctualFilter punctual_;
    const Light* result_ = nullptr;
    const gpu::Buffer* punctual_result_ = nullptr;
};

} // namespace fieldcast::render
