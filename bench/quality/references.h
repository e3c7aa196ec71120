// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/light_field_run.h"
#include "bench/picture_id.h"
#include "bench/quality/reference_picture.h"
#include "core/render/reference_renderer.h"

#include <functional>

namespace fieldcast::bench {

/// Views path traced with many samples, without clamps, stored as files: an EXR of linear radiance for each half of the
/// samples, and a JSON description next to it. The work can be interrupted at any time and continues from saved files.
class References {
public:
    /// `folder` gets a subfolder per scene.
    References(const gpu::Device& device, LightFieldScene& scene, std::filesystem::path folder,
               image::ExrPrecision precision = image::ExrPrecision::kFloat);

    /// `done`: samples added to this view so far; false: stop (the image is saved).
    using Progress = std::function<bool(std::uint32_t done)>;

    /// A view of the scene's current pose, which is that of `frame`, with at least `samples` per pixel. Renders missing
    /// samples. Empty if `progress` stopped it.
    std::optional<ReferencePicture> get(std::uint32_t frame, LatticePosition position, std::uint32_t samples,
                                        const Progress& progress);

    /// Number of samples that the two halves of this view lack together. Files of other scenes or settings do not
    /// count.
    std::uint32_t lacking(std::uint32_t frame, LatticePosition position, std::uint32_t samples) const;

private:
    /// One of the two pictures of a view.
    struct Part {
        std::uint32_t frame = 0;
        LatticePosition position;
        std::uint32_t half = 0; ///< 0 or 1
    };

    std::filesystem::path file_of(const Part& part) const;
    nlohmann::ordered_json description(const Part& part) const;
    std::uint32_t samples_of(const Part& part) const;
    void save(const Part& part, const Camera& camera) const;
    bool add_samples(const Part& part, std::uint32_t samples, const Progress& progress);

    LightFieldScene& scene_;
    std::filesystem::path folder_;
    image::ExrPrecision precision_;
    render::ReferenceRenderer renderer_;
};

/// Makes the missing references of `wanted` and prints progress. Poses the scene. After Ctrl-C it saves the references
/// made so far and throws Interrupted.
void make_references(LightFieldScene& scene, References& references, const std::vector<PictureId>& wanted,
                     std::uint32_t samples);

} // namespace fieldcast::bench
