// SPDX-License-Identifier: Apache-2.0
// Light that the source images already contain, for rays that come from elsewhere. The including kernel has
// `params.settings` (ReprojectSettings) and binds set 1.
#ifndef FIELDCAST_LIB_SOURCE_LIGHT
#define FIELDCAST_LIB_SOURCE_LIGHT
#include "lib/known_light.glsl"
#include "lib/reprojection.glsl"

// Light that `s` reflects to any viewer, from the sources' illumination of that surface, without its emission. False if
// no source shows it, or if its light depends on the viewer too much.
bool light_in_source(CameraBuffer cameras, Surface s, uint instance, Bsdf b, out vec3 reflected) {
    reflected = vec3(0.0);
    if (!looks_alike_from_anywhere(s, b)) {
        return false;
    }
    Gathered sum = Gathered(vec3(0.0), vec3(0.0), 0.0, kDiscardFrustum);
    for (uint i = 0u; i < params.settings.source_count && sum.weight < params.settings.min_weight; ++i) {
        CameraRecord source = cameras.at[i];
        vec3 p = camera_project(source, s.position);
        vec2 size = vec2(camera_size(source));
        bool is_inside = p.z > 0.0 && all(greaterThanEqual(p.xy, vec2(0.0))) && all(lessThan(p.xy, size));
        if (is_inside && dot(s.geometric_normal, source.origin - s.position) > 0.0) { // it sees the same side
            vec3 from_source = normalize(s.position - source.origin);
            sum = gather_around(source, i, p.xy, make_target(s, instance, from_source, p.z / source.focal_px, p.z));
        }
    }
    if (sum.weight < params.settings.min_weight) {
        return false;
    }
    reflected = (sum.diffuse * b.diffuse_modulation + sum.specular * b.specular_modulation) / sum.weight;
    return true;
}

#endif
