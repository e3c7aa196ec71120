// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/coded_plane.h"
#include "bench/light_field_run.h"

#include <map>
#include <memory>
#include <utility>

namespace fieldcast::bench {

/// Settings of `codecs`.
struct CodecsSettings {
    std::vector<std::uint32_t> qualities{50, 75, 90};
    std::uint32_t frames = 8;
    std::uint32_t measured = 2; ///< number of last frames that are measured, fewer than `frames`
    float exposure = 0.0F;      ///< 0: automatic
};

/// Encodes the planes and views of a scene's frames in every coding, and makes views from the decoded light of lossy
/// codings.
class CodecsRun {
public:
    CodecsRun(const gpu::Device& device, LightFieldScene& scene, const CodecsSettings& settings);

    /// Throws Interrupted.
    void run();

    /// source_size, guard_band_share, frames, view_count, coarse_normals_deg (angle between normals of 8 bits a
    /// component and those of 16: mean of the last frame, and max), and `rows`: part (a plane, "light": DIFFUSE and
    /// SPECULAR, "total light": TOTAL_LIGHT in their place, or "view": one view), coding, bytes, encode_ms, decode_ms,
    /// ssim, discard_points. Bytes are means, times medians over frames and views. ssim of light, total light and
    /// coarse normals is that of the views made from them; null for lossless codings.
    nlohmann::ordered_json result() const;

private:
    /// Measurements of one part in one coding, per plane or view.
    struct Samples {
        std::vector<double> bytes;
        std::vector<double> encode_ms;
        std::vector<double> decode_ms;
        std::vector<double> ssim;           ///< of views against the same views without coding
        std::vector<double> discard_points; ///< change of the share of discarded pixels, percentage points

        void add(const CodedPlane& coded);
    };
    void measure(const SourceFrame& frame);
    /// Encodes the planes to which the coding applies; the result contains the decoded planes instead.
    SourceFrame measure_planes(const SourceFrame& frame, const Coding& coding);
    void measure_coarse_normals(SourceFrame frame, const Views& uncoded);
    void measure_total_light(const SourceFrame& frame, const Views& uncoded);
    void measure_views(const Views& views, const Coding& coding);
    void compare(const Views& views, const Views& uncoded, Samples& samples) const;
    Views make_views(render::GridRenderer& renderer, const SourceFrame& frame);
    Samples& samples(const std::string& part, const Coding& coding);
    static nlohmann::ordered_json row(const std::string& part, const Coding& coding, const Samples& samples);

    LightFieldScene& scene_;
    CodecsSettings settings_;
    std::vector<Coding> codings_;
    std::vector<LatticePosition> positions_; ///< positions of the views that are made
    LightFieldRun run_;
    render::SourcePlanes planes_;
    render::SurfacePlanesRenderer surfaces_;
    render::GridRenderer uncoded_;
    render::GridRenderer coarse_; ///< makes views from coarse normals
    std::vector<std::unique_ptr<render::GridRenderer>> renderers_; ///< one per coding that changes light, else null
    std::vector<std::unique_ptr<render::GridRenderer>>
        merged_; ///< the same for total light; also for one lossless coding
    SourceFrame before_;                                           ///< the previous frame
    double mean_angle_deg_ = 0.0;    ///< between normals and coarse ones, last frame
    double largest_angle_deg_ = 0.0; ///< of all frames
    Views views_before_;                                           ///< empty in the first frame that is measured
    std::map<std::pair<std::string, std::string>, Samples> samples_; ///< by part and coding
};

} // namespace fieldcast::bench
