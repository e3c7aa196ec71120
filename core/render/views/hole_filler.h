// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/render/source/source_planes.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/holes.h"

#include <array>

namespace fieldcast::render {

/// Where the holes of one frame's views got their light from. All counts are pixels over all views.
struct HoleCounts {
    std::uint64_t holes = 0;
    std::uint64_t remembered = 0; ///< from the frame before
    std::uint64_t isolated = 0;   ///< from around their place in the source
    std::uint64_t cascaded = 0;   ///< from corner views
    std::uint64_t traced = 0;
};

/// Holes of this frame and the one before of one set of views.
struct HoleHistory {
    struct Frame {
        gpu::Buffer cameras;
        gpu::Buffer words; ///< the map
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

/// Fills the pixels that no source pixel could be reused for (settings.holes says how). Reprojection marks them in a
/// map of one bit per pixel; the rest works on arrays that hold only holes, in the order of the map.
class HoleFiller {
public:
    /// Binding set 1 of all its kernels has `source_layout`.
    HoleFiller(const gpu::Device& device, const scene::GpuScene& scene, const gpu::BindingLayout& source_layout);

    /// Gives back the memory of what was filled last; its history may go.
    void forget();

    /// Views of one frame.
    struct Batch {
        HoleHistory* history = nullptr; ///< must outlive the frame
        bool has_history = false;       ///< its frame before is of the same views and of the pose before
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::uint32_t view_count = 0;
        std::vector<std::uint32_t>
            corners{}; ///< indices of the cascade's corner views, at most four; empty: no cascade
    };

    /// Makes room and records clearing of the map, in which reprojection then marks holes. `cameras`: CameraRecords of
    /// source and views, copied into the history.
    void begin(gpu::Recorder& recorder, const Batch& batch, const gpu::Buffer& cameras);
    const gpu::Buffer& map() const { return batch_.history->now().words; }

    /// What filling reads and writes besides the map.
    struct Targets {
        const gpu::Buffer& visibility;
        const gpu::Buffer& views;
        const gpu::Buffer& counters;
        const gpu::Buffer& radiance;
        const gpu::BindingSet& source_set;
        const shared::ViewLight* light = nullptr; ///< if views are filtered: gets what radiance would
    };

    /// Numbers the holes and submits the recorder, since their count decides how large arrays must be; `times` gets the
    /// stages so far. Then records the filling of `targets.radiance` or `targets.light`.
    void fill(gpu::Recorder& recorder, const FrameHeader& header, const Targets& targets,
              std::vector<StageTime>& times);

    /// What the counters of the batch say once all is done.
    static HoleCounts counts(const std::vector<std::uint32_t>& counters);

    /// Holes of one view of the batch, row-major; until the next begin().
    std::vector<bool> mask(std::uint32_t view) const;

private:
    void number_holes(gpu::Recorder& recorder, const gpu::Buffer& counters);
    void reserve(std::uint32_t hole_count);
    shared::HoleParams make_params(const FrameHeader& header, const Targets& targets) const;
    void trace_list(gpu::Recorder& recorder, const Targets& targets, shared::HoleParams params, std::uint32_t list);
    void keep(gpu::Recorder& recorder, const shared::ViewLight& light, const shared::HoleParams& params) const;
    void smooth_and_shade(gpu::Recorder& recorder, const FrameHeader& header, const Targets& targets,
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
    std::uint32_t word_count_ = 0; ///< of the map, over all views
    std::uint32_t hole_count_ = 0;
    gpu::Buffer frame_records_;
    gpu::Buffer blocks_;
    gpu::Buffer lists_;
    gpu::Buffer filtered_;
};

} // namespace fieldcast::render
