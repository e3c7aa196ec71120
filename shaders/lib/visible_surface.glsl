// SPDX-License-Identifier: Apache-2.0
// The surface that a pixel of a view sees.
#ifndef FIELDCAST_LIB_VISIBLE_SURFACE
#define FIELDCAST_LIB_VISIBLE_SURFACE
#include "lib/camera.glsl"
#include "lib/surface.glsl"

// `direction` becomes the unit viewing direction, `cone_width` the pixel's width at the surface in metres.
Surface visible_surface(CameraRecord camera, vec2 position, Visibility seen, out vec3 direction, out float cone_width) {
    direction = camera_direction(camera, position);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    cone_width = at.z / camera.focal_px;
    direction = normalize(direction);
    return make_surface(triangle, at.xy, direction, cone_width);
}

#endif
