// SPDX-License-Identifier: Apache-2.0
// Specular light whose place in the image is that of the reflected object, not of the reflecting surface. The including
// kernel has `params.settings` (ReprojectSettings) and binds set 1.
#ifndef FIELDCAST_LIB_REFLECTION
#define FIELDCAST_LIB_REFLECTION
#include "lib/bsdf.glsl"
#include "lib/lobe.glsl"
#include "lib/reprojection.glsl"

const float kMirrorRoughness = 0.08; // up to this, half of the lobe fits into a pixel of common sizes

// Turn of the lobe from a source to the viewer, 0 to 1. At 0 the surface's light looks the same from both; at 1 only
// the reflected objects determine it.
float lobe_turn(Surface s, vec3 view, CameraRecord source) {
    float turned = sqrt(2.0 * max(0.0, 1.0 - dot(view, normalize(source.origin - s.position))));
    return smoothstep(1.0 / 6.0, 0.5, turned / max(lobe_angle(s.roughness), 1e-4));
}

// Whether a surface's specular light needs a ray to what it reflects. Objects seen through a thin wall have no virtual
// image.
bool is_glossy(Surface s, Bsdf b, vec3 view, CameraRecord source) {
    bool counts = luminance(b.specular_modulation) > 0.02 && luminance(s.transmission) == 0.0;
    return counts && s.roughness < kGlossyRoughness &&
           (s.roughness <= kMirrorRoughness || lobe_turn(s, view, source) > 0.0);
}

// Mean curvature of the shading normals along the triangle's edges, 1/m; positive where the viewer's side bulges.
float mean_curvature(WorldTriangle t, Surface s) {
    vec3 n0 = normalize(world_normal(t.world_from_object, t.is_mirrored, unpack_normal(t.normals.x)));
    vec3 n1 = normalize(world_normal(t.world_from_object, t.is_mirrored, unpack_normal(t.normals.y)));
    vec3 n2 = normalize(world_normal(t.world_from_object, t.is_mirrored, unpack_normal(t.normals.z)));
    vec3 edge3 = t.edge2 - t.edge1;
    float sum = dot(n1 - n0, t.edge1) / max(dot(t.edge1, t.edge1), 1e-20) +
                dot(n2 - n0, t.edge2) / max(dot(t.edge2, t.edge2), 1e-20) +
                dot(n2 - n1, edge3) / max(dot(edge3, edge3), 1e-20);
    return dot(n0 + n1 + n2, s.normal) >= 0.0 ? sum / 3.0 : -sum / 3.0;
}

// Place where the viewer sees the virtual image of an object that lies `distance_m` away along the mirror direction.
// The lobe of a rough surface leans towards the normal, which brings its image nearer: S. Lagarde, C. de Rousiers.
// Moving Frostbite to Physically Based Rendering. SIGGRAPH courses 2014 (dominant direction); curvature by the equation
// of thin mirrors, 1/image = 1/object + 2 κ / cos. False: there is no image behind the surface.
bool virtual_image(Surface s, float curvature, vec3 direction, float distance_m, out vec3 position) {
    float facing = max(-dot(s.normal, direction), 0.05);
    float vergence = 1.0 / max(distance_m, 1e-6) + 2.0 * curvature / facing;
    float lean = (1.0 - s.roughness) * (sqrt(1.0 - s.roughness) + s.roughness);
    position = s.position + direction * (lean / max(vergence, 1e-9));
    return vergence > 0.0;
}

// Adds the specular light of one source pixel if it shows the reflecting surface with a similar normal and roughness.
void gather_reflection(CameraRecord source, uint page, ivec2 at, float weight, Target target, float roughness,
                       inout vec4 sum) {
    ivec2 size = ivec2(camera_size(source));
    if (weight <= 0.0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) {
        return;
    }
    int texel = (int(page) * size.y + at.y) * size.x + at.x;
    uvec4 geometry = texelFetch(source_geometry_, texel);
    if (geometry.z != target.id) {
        return;
    }
    vec3 position = source.origin + camera_direction(source, vec2(at) + 0.5) * uintBitsToFloat(geometry.x);
    vec3 offset = position - target.position;
    bool same = abs(dot(offset, target.geometric_normal)) <= target.plane_limit_m + 0.1 * length(offset) &&
                dot(unpack_normal(geometry.y), target.normal) >= 0.95 &&
                abs(float(geometry.w & 255u) / 255.0 - roughness) <= 0.1;
    if (same) {
        sum += weight * vec4(unpack_r11g11b10(texelFetch(source_illumination_, texel).y), 1.0);
    }
}

// Specular light of the sources' pixels that show the virtual image; false: none does.
bool gather_virtual_image(CameraRecord source, uint page, vec3 image, Target target, float roughness, out vec3 specular) {
    vec3 p = camera_project(source, image);
    vec4 sum = vec4(0.0);
    if (p.z > 0.0) {
        vec2 corner = floor(p.xy - 0.5);
        vec2 f = p.xy - 0.5 - corner;
        for (int i = 0; i < 4; ++i) {
            ivec2 step = ivec2(i & 1, i >> 1);
            float weight = (step.x == 1 ? f.x : 1.0 - f.x) * (step.y == 1 ? f.y : 1.0 - f.y);
            gather_reflection(source, page, ivec2(corner) + step, weight, target, roughness, sum);
        }
    }
    specular = sum.rgb / max(sum.a, 1e-6);
    return sum.a >= 0.25;
}

#endif
