// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/ground_truth.h"

#include "bench/quality/motion.h"

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kRowsPerMargin = 45; // around moving objects: 4 of 180 rows, 16 of 720

} // namespace

GroundTruth::GroundTruth(LightFieldScene& scene, References& references, const Protocol& protocol)
    : scene_(scene), references_(references), protocol_(protocol) {}

void GroundTruth::note_frame(const ViewMaker& maker) {
    noted_time_ns_ = scene_.gpu_scene().current_pose().time_ns;
    for (const LatticePosition position : protocol_.views) {
        noted_[position] = maker.surfaces(position);
    }
}

void GroundTruth::add_motion(ViewTruth& truth, std::uint32_t frame, LatticePosition position, const ViewMaker& maker) {
    const std::int64_t time_before_ns = LightFieldScene::time_of_frame_ns(frame - 1);
    const image::ViewSurfaces surfaces = maker.surfaces(position);
    const Motion motion = find_motion(scene_.scene(), scene::pose_scene(scene_.scene(), time_before_ns),
                                      scene_.gpu_scene().current_pose());
    truth.moving =
        moving_mask(surfaces, motion.is_moving, (scene_.size().height_px + kRowsPerMargin - 1) / kRowsPerMargin);
    if (noted_time_ns_ == time_before_ns) {
        truth.before = image::find_correspondence(surfaces, noted_.at(position), motion.before_from_now);
    }
}

std::map<LatticePosition, ViewTruth> GroundTruth::of_frame(std::uint32_t frame, const ViewMaker* maker) {
    std::map<LatticePosition, ViewTruth> truths;
    const std::uint32_t samples = protocol_.reference_samples;
    for (const LatticePosition position : protocol_.views) {
        ViewTruth& truth = truths[position];
        truth.reference = references_.get(frame, position, samples, {}).value();
        if (frame > 0 && references_.lacking(frame - 1, position, samples) == 0) {
            truth.reference_before = references_.get(frame - 1, position, samples, {}).value().mean;
        }
        if (frame > 0 && maker != nullptr) {
            add_motion(truth, frame, position, *maker);
        }
    }
    return truths;
}

} // namespace fieldcast::bench
