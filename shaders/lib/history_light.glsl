// SPDX-License-Identifier: Apache-2.0
// Light that the sources of the frame before showed, for paths of this frame: their denoised illumination as a radiance
// cache in screen space. The including kernel has TraceSourceParams `params`.
#ifndef FIELDCAST_LIB_HISTORY_LIGHT
#define FIELDCAST_LIB_HISTORY_LIGHT
#include "lib/camera.glsl"
#include "lib/history_taps.glsl"
#include "lib/known_light.glsl"

// Texel of a source of the previous frame: the pixel nearest to `position`; kNoIndex if it shows another surface.
uint texel_in_history(uint source, vec3 position, Surface s, uint id) {
    CameraRecord camera = params.cameras.at[params.source_count + source];
    vec3 p = camera_project(camera, position);
    vec3 view = camera.origin - position;
    float facing = dot(s.geometric_normal, view);
    if (!(p.z > 0.0 && facing > 0.0 && all(greaterThanEqual(p.xy, vec2(0.0))) &&
          all(lessThan(p.xy, vec2(camera_size(camera)))))) {
        return kNoIndex;
    }
    uvec2 at = uvec2(p.xy);
    uint texel = (source * params.height + at.y) * params.width + at.x;
    uvec4 geometry = params.previous_geometry.at[texel];
    vec3 offset = camera.origin + camera_direction(camera, vec2(at) + 0.5) * uintBitsToFloat(geometry.x) - position;
    vec2 limits_m = tap_limits_m(p.z, camera.focal_px, facing / length(view));
    bool is_same = geometry.z == id && is_same_surface(offset, geometry.y, s.geometric_normal, s.normal, limits_m);
    return is_same ? texel : kNoIndex;
}

// Light that `s` reflects to any viewer, without its emission. False if no source showed it, or if its light depends on
// the viewer too much.
bool light_in_history(WorldTriangle t, vec2 barycentrics, Surface s, Bsdf b, out vec3 reflected) {
    reflected = vec3(0.0);
    if (!looks_alike_from_anywhere(s, b)) {
        return false;
    }
    vec3 position = previous_position(t.instance, t.vertices, barycentrics);
    for (uint i = 0u; i < params.source_count; ++i) {
        uint texel = texel_in_history(i, position, s, (t.instance << 12) | s.material);
        if (texel != kNoIndex) {
            reflected = unpack_r11g11b10(params.previous_diffuse.at[texel]) * b.diffuse_modulation +
                        unpack_r11g11b10(params.previous_specular.at[texel]) * b.specular_modulation;
            return true;
        }
    }
    return false;
}

#endif
