// SPDX-License-Identifier: Apache-2.0
#include "core/render/frame_parameters.h"

namespace fieldcast::render {

namespace {

std::uint32_t pcg_hash(std::uint32_t value) {
    const std::uint32_t state = value * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
    return (word >> 22U) ^ word;
}

} // namespace

std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
    return pcg_hash(a ^ (b + 0x9E3779B9U + (a << 6U) + (a >> 2U)));
}

std::uint32_t view_seed(const FrameHeader& header, LatticePosition position) {
    std::uint32_t seed = hash_combine(header.seed, header.noise_frame);
    seed = hash_combine(seed, static_cast<std::uint32_t>(position.row_halves));
    return hash_combine(seed, static_cast<std::uint32_t>(position.col_halves));
}

void append_times(const gpu::CommandRecorder& recorder, std::vector<StageTime>& times) {
    for (const gpu::StageDuration& duration : recorder.durations()) {
        times.push_back({duration.stage, duration.ms});
    }
}

} // namespace fieldcast::render
