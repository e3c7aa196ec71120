// SPDX-License-Identifier: Apache-2.0
#include "core/render/denoise/illumination_filter.h"

namespace fieldcast::render {

IlluminationFilter::IlluminationFilter(const gpu::Device& device, const scene::GpuScene& scene)
    : accumulation_(device, scene), svgf_(device, accumulation_), bmfr_(device, accumulation_),
      punctual_(device, accumulation_), result_(&accumulation_.noisy()) {}

void IlluminationFilter::record(gpu::CommandRecorder& recorder, const FilterFrame& frame) {
    if (frame.is_still || frame.settings.denoiser != Denoiser::kBmfr) {
        bmfr_.forget();
    }
    punctual_result_ = nullptr;
    if (frame.is_still) {
        accumulation_.record(recorder, frame, {});
        punctual_result_ = frame.is_punctual_apart ? &accumulation_.now().punctual.buffer : nullptr;
        result_ = &accumulation_.now().light;
        return;
    }
    switch (frame.settings.denoiser) {
    case Denoiser::kNone:
        result_ = &accumulation_.noisy();
        if (frame.settings.temporal_accumulation) {
            accumulation_.record(recorder, frame, {});
            result_ = &accumulation_.now().light;
        }
        break;
    case Denoiser::kSvgf:
    case Denoiser::kSvgfPlus:
        accumulation_.record(recorder, frame, Svgf::accumulation_options(frame.settings.denoiser));
        result_ = &svgf_.record(recorder, frame);
        punctual_result_ = frame.is_punctual_apart ? &punctual_.record(recorder, frame) : nullptr;
        break;
    case Denoiser::kBmfr:
        accumulation_.record(recorder, frame, Bmfr::accumulation_options());
        result_ = &bmfr_.record(recorder, frame);
        break;
    }
}

} // namespace fieldcast::render
