// SPDX-License-Identifier: Apache-2.0
// Cameras, visibility and the parameters of the kernels of a frame.
#ifndef FIELDCAST_SHARED_FRAME_H
#define FIELDCAST_SHARED_FRAME_H
#include "types.h"

SHARED_BEGIN

// A pinhole as in core/lightfield/camera.h.
struct CameraRecord {
    vec3 origin;      // world space, metres
    float focal_px;
    vec3 right;       // unit vectors, world space
    float principal_x;
    vec3 up;
    float principal_y;
    vec3 forward;
    uint size_px;     // width | height << 16
};
SHARED_BUFFER(CameraBuffer, CameraRecord);

// What a pixel sees: the first surface that is not BLEND.
struct Visibility {
    uint instance;    // kNoInstance: nothing
    uint primitive;
};
SHARED_BUFFER(VisibilityBuffer, Visibility);

SHARED_END
#endif
