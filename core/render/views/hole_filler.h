// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/render/source/source_planes.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/holes.h"

#include <array>

namespace fieldcast::render {

/// Counts of one frame's holes by the origin of their light, in pixels over all views.
struct HoleCounts {
    std::uint64_t holes = 0;
    std::uint64_t remembered = 0; ///< light of the previous frame
    std::uint64_t isolated = 0;   ///< light of the neighbourhood in the source
    std::uint64_t cascaded = 0;   ///< light of corner views
    std::uint64_t traced = 0;
};

/// Holes of one set of views, in this frame and the previous one.
struct HoleHistory {
    struct Frame {
        gpu::Buffer cameras;
        gpu::Buffer words; ///< the map: one bit per pixel
        gpu::Buffer first;
        gpu::Buffer pixels;
        gpu::Buffer surfaces;
        gpu::Buffer light;
        shared::HoleFrame record() const;
    };
    std::array<Frame, 2> frames;
    std::uint32_t current = 0;
    Frame& now() { return frames[current]; }
    const Frame& now() const { return frames[current]; }
    const Frame& before() const { return frames[1 - current]; }
};

/// Fills the pixels for which no source pixel could be reused; settings.holes chooses the stages. Reprojection marks
/// these holes in a map of one bit per pixel. Later passes work on arrays of holes only, in the order of the map.
class HoleFiller {
public:
    /// `source_layout`: layout of binding set 1 of all kernels.
    HoleFiller(const gpu::Device& device, const scene::GpuScene& scene, const gpu::BindingLayout& source_layout);

    /// Frees the memory of the last batch, whose history may be destroyed afterwards.
    void forget();

    /// Views of one frame.
    struct Batch {
        HoleHistory* history = nullptr; ///< must outlive the frame
        bool has_history = false;       ///< the history holds the previous pose of the same views
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::uint32_t view_count = 0;
        std::vector<std::uint32_t>
            corners{}; ///< indices of the corner views, at most four; empty: no cascade
    };

    /// Allocates buffers and records the clearing of the map, in which reprojection then marks holes. `cameras` holds
    /// the CameraRecords of source and views, which are copied into the history.
    void begin(gpu::CommandRecorder& recorder, const Batch& batch, const gpu::Buffer& cameras);
    const gpu::Buffer& map() const { return batch_.history->now().words; }

    /// Buffers that fill() reads and writes besides the map.
    struct Targets {
        const gpu::Buffer& visibility;
        const gpu::Buffer& views;
        const gpu::Buffer& counters;
        const gpu::Buffer& radiance;
        const gpu::BindingSet& source_set;
        const shared::ViewLight* light = nullptr; ///< output instead of `radiance` if views are filtered
    };

    /// Numbers the holes and submits the recorder, because the array sizes depend on their count. Appends the stage
    /// times so far to `times`. Then records the filling of `targets.radiance` or `targets.light`.
    void fill(gpu::CommandRecorder& recorder, const FrameHeader& header, const Targets& targets,
              std::vector<StageTime>& times);

    /// Decodes the batch's counters, which are final after the last submission.
    static HoleCounts counts(const std::vector<std::uint32_t>& counters);

    /// Holes of one view of the batch, row-major; valid until the next begin().
    std::vector<bool> mask(std::uint32_t view) const;

private:
    void number_holes(gpu::CommandRecorder& recorder, const gpu::Buffer& counters);
    void reserve(std::uint32_t hole_count);
    shared::HoleParams make_params(const FrameHeader& header, const Targets& targets) const;
    void trace_list(gpu::CommandRecorder& recorder, const Targets& targets, shared::HoleParams params,
                    std::uint32_t list);
    void keep(gpu::CommandRecorder& recorder, const shared::ViewLight& light, const shared::HoleParams& params) const;
    void smooth_and_shade(gpu::CommandRecorder& recorder, const FrameHeader& header, const Targets& targets,
                          shared::HoleParams params);

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::Kernel count_;
    gpu::Kernel scan_;
    gpu::Kernel list_;
    gpu::Kernel finish_;
    gpu::Kernel start_;
    gpu::Kernel trace_;
    gpu::Kernel cascade_;
    gpu::Kernel filter_;
    gpu::Kernel shade_;
    gpu::Kernel keep_;
    Batch batch_;
    std::uint32_t word_count_ = 0; ///< words of the map, over all views
    std::uint32_t hole_count_ = 0;
    gpu::Buffer frame_records_;
    gpu::Buffer blocks_;
    gpu::Buffer lists_;
    gpu::Buffer filtered_;
};

} // namespace fieldcast::render
