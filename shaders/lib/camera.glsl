// SPDX-License-Identifier: Apache-2.0
// Pinhole cameras: the kernel side of core/lightfield/camera.h.
#ifndef FIELDCAST_LIB_CAMERA
#define FIELDCAST_LIB_CAMERA
#include "shared/frame.h"

uvec2 camera_size(CameraRecord camera) {
    return uvec2(camera.size_px & 0xFFFFu, camera.size_px >> 16);
}

// Direction through image position `p`, not normalised: its depth component is 1.
vec3 camera_direction(CameraRecord camera, vec2 p) {
    float inverse_focal = 1.0 / camera.focal_px;
    return camera.forward + camera.right * ((p.x - camera.principal_x) * inverse_focal) -
           camera.up * ((p.y - camera.principal_y) * inverse_focal);
}

// Image position and view depth of a world point.
vec3 camera_project(CameraRecord camera, vec3 world) {
    vec3 offset = world - camera.origin;
    float depth = dot(offset, camera.forward);
    float scale = camera.focal_px / depth;
    return vec3(camera.principal_x + dot(offset, camera.right) * scale,
                camera.principal_y - dot(offset, camera.up) * scale, depth);
}

#endif
