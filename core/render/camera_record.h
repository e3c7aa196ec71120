// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "shaders/shared/frame.h"

#include <algorithm>
#include <span>
#include <vector>

namespace fieldcast::render {

/// The record of `camera` that kernels read.
inline shared::CameraRecord make_camera_record(const Camera& camera) {
    shared::CameraRecord record{};
    record.origin = glm::vec3(camera.world_from_camera[3]);
    record.right = glm::vec3(camera.world_from_camera[0]);
    record.up = glm::vec3(camera.world_from_camera[1]);
    record.forward = -glm::vec3(camera.world_from_camera[2]);
    record.focal_px = camera.focal_px;
    record.principal_x = camera.principal_px.x;
    record.principal_y = camera.principal_px.y;
    record.size_px = camera.width_px | camera.height_px << 16;
    return record;
}

inline std::vector<shared::CameraRecord> make_camera_records(std::span<const Camera> cameras) {
    std::vector<shared::CameraRecord> records(cameras.size());
    std::ranges::transform(cameras, records.begin(), make_camera_record);
    return records;
}

} // namespace fieldcast::render
