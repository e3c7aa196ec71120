// SPDX-License-Identifier: Apache-2.0
// Light that the source images already know, for paths that begin elsewhere. The including kernel has `params`
// (HoleParams) and binds set 1.
#ifndef FIELDCAST_LIB_SOURCE_LIGHT
#define FIELDCAST_LIB_SOURCE_LIGHT
#include "lib/bsdf.glsl"
#include "lib/holes.glsl"

const float kMaxSpecularShare = 0.25; // of a surface that may be seen from elsewhere than the source

// Light that `s` reflects against `direction`, from the source's illumination of that surface; false: the source does
// not show it, or what it shows depends on the viewer too much. Emission is not part of it.
bool light_in_source(Surface s, uint instance, Bsdf b, vec3 direction, float distance_m, out vec3 reflected) {
    reflected = vec3(0.0);
    bool is_rough = s.roughness >= 0.35 || luminance(b.specular_modulation) <= 0.05;
    float specular_share = luminance(b.specular_modulation) / max(luminance(b.diffuse_modulation + b.specular_modulation), 1e-6);
    if ((params.stages & kHolesEndInSource) == 0u || !is_rough || specular_share > kMaxSpecularShare) {
        return false;
    }
    CameraBuffer cameras = params.frames.at[0].cameras;
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
