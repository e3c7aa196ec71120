// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/light_field_run.h"
#include "bench/picture_id.h"
#include "core/image/image_file.h"
#include "core/render/reference_renderer.h"

#include <functional>

namespace fieldcast::bench {

/// Views path traced with many samples, without clamps, kept as files: an EXR of linear radiance, and beside it what it
/// is of. Making them can be interrupted at any time; it goes on from what was saved.
class References {
public:
    /// `folder` gets a subfolder per scene.
    References(const gpu::Device& device, LightFieldScene& scene, std::filesystem::path folder);

    /// `done`: samples of this view so far; false: stop (the image is saved).
    using Progress = std::function<bool(std::uint32_t done)>;

    /// View of the scene's current pose, which is that of `frame`, with at least `samples` per pixel; makes what is
    /// missing. Empty if `progress` stopped it.
    std::optional<image::RgbF32> get(std::uint32_t frame, LatticePosition position, std::uint32_t samples,
                                     const Progress& progress);

    /// Samples that the file of this view has; 0: there is none, or it is of another scene or other settings.
    std::uint32_t samples_of(std::uint32_t frame, LatticePosition position) const;

private:
    std::filesystem::path file_of(std::uint32_t frame, LatticePosition position) const;
    nlohmann::ordered_json description() const;
    void save(const std::filesystem::path& file, const Camera& camera) const;

    LightFieldScene& scene_;
    std::filesystem::path folder_;
    render::ReferenceRenderer renderer_;
};

/// Makes the references of `wanted` that are missing and says how far it is. Poses the scene. Throws Interrupted after
/// Ctrl-C, when what was made so far is saved.
void make_references(LightFieldScene& scene, References& references, const std::vector<PictureId>& wanted,
                     std::uint32_t samples);

} // namespace fieldcast::bench
