// SPDX-License-Identifier: Apache-2.0
// Features that illumination is fitted to, block by block. The including kernel has `params` (BmfrParams).
#ifndef FIELDCAST_LIB_BLOCK_FIT
#define FIELDCAST_LIB_BLOCK_FIT
#include "lib/filter_taps.glsl"

// The features besides 1.
struct Features {
    vec3 normal;
    vec3 position;
    vec3 square;
};

// Means and scale that the features are relative to, as in BlockFit.
struct FitFrame {
    vec3 normal;
    vec3 centre;
    vec3 scale;
};

// From the camera to the surface that a pixel shows, metres along the world's axes.
vec3 camera_offset(CameraRecord camera, ivec2 at, uvec4 geometry) {
    return camera_direction(camera, vec2(at) + 0.5) * uintBitsToFloat(geometry.x);
}

Features make_features(FitFrame frame, vec3 offset, vec3 normal) {
    vec3 q = (offset - frame.centre) * frame.scale;
    return Features(normal - frame.normal, q, q * q);
}

#endif
